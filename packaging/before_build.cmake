# Run by CPack when all components are installed and none is packed: the log of changes of each package in Debian's form, and
# manual pages compressed as Debian wants them. The same every time: dates are those of SOURCE_DATE_EPOCH.
if(DEFINED ENV{SOURCE_DATE_EPOCH})
  set(ENV{TZ} UTC)
else()
  message(FATAL_ERROR "SOURCE_DATE_EPOCH is not set; ./dev package does it")
endif()
set(ENV{LC_ALL} C)
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)

file(GLOB packages LIST_DIRECTORIES true ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/*)
foreach(root ${packages})
  get_filename_component(package ${root} NAME)
  set(log ${root}/usr/share/doc/${package}/changelog)
  file(WRITE ${log} "${package} (${CPACK_DEBIAN_PACKAGE_VERSION}) unstable; urgency=medium\n\n"
                    "  * What has changed: CHANGELOG.md, in hapticd-doc.\n\n"
                    " -- ${CPACK_PACKAGE_CONTACT}  ${date}\n")
  file(GLOB_RECURSE pages ${root}/usr/share/man/*.[0-9])
  foreach(file ${log} ${pages})
    execute_process(COMMAND gzip -9nf ${file} COMMAND_ERROR_IS_FATAL ANY)
  endforeach()
endforeach()
