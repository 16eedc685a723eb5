#include "client/cli/changes.h"

#include <cmath>
#include <fstream>
#include <iterator>
#include <utility>

#include "client/cli/scene_text.h"

namespace haptic::cli {
namespace {

using Numbers = std::vector<double>;

v1::Vector3 vector(const Numbers& numbers, std::size_t first = 0) {
  v1::Vector3 v;
  v.set_x(numbers.at(first));
  v.set_y(numbers.at(first + 1));
  v.set_z(numbers.at(first + 2));
  return v;
}

// inf and nan are numbers for the parser of arguments
std::string check_finite(const std::string& text) {
  double number = 0.0;
  const bool good = CLI::detail::lexical_cast(text, number) && std::isfinite(number);
  return good ? "" : "'" + text + "' is no finite number";
}

const CLI::Validator& finite() {
  static const CLI::Validator validator(check_finite, "");
  return validator;
}

CLI::Option* add_numbers(CLI::App& verb, const std::string& name, int count, const std::string& type,
                         const std::string& help, const std::function<void(const Numbers&)>& take) {
  return verb.add_option_function<Numbers>(name, take, help)
      ->expected(count)
      ->check(finite())
      ->type_name(type);
}

CLI::Option* add_number(CLI::App& verb, const std::string& name, const std::string& type,
                        const std::string& help, const std::function<void(double)>& take) {
  return verb.add_option_function<double>(name, take, help)->check(finite())->type_name(type);
}

CLI::Option* add_count(CLI::App& verb, const std::string& name, const std::string& help,
                       const std::function<void(std::uint32_t)>& take) {
  return verb.add_option_function<std::uint32_t>(name, take, help)->type_name("N");
}

CLI::Option* add_text(CLI::App& verb, const std::string& name, const std::string& type,
                      const std::string& help, const std::function<void(const std::string&)>& take) {
  return verb.add_option_function<std::string>(name, take, help)->type_name(type);
}

// the names of the fields that are there; of a sub-message that stays, those within
std::vector<std::string> fields_of(const google::protobuf::Message& message, const std::string& prefix) {
  std::vector<const google::protobuf::FieldDescriptor*> present;
  message.GetReflection()->ListFields(message, &present);
  std::vector<std::string> fields;
  for (const auto* field : present) {
    const std::string name = prefix + field->name();
    const bool inner = name == "dynamic" || name == "pose";
    const std::vector<std::string> within =
        inner ? fields_of(message.GetReflection()->GetMessage(message, field), name + ".")
              : std::vector<std::string>{};
    if (within.empty()) {
      fields.push_back(name);
    }
    fields.insert(fields.end(), within.begin(), within.end());
  }
  return fields;
}

// what the schema says and no option does: as text, or in a file
template <typename Message>
void add_message_options(CLI::App& verb, Changes<Message>& changes) {
  const auto take = [&changes](const std::string& option, const std::string& text) {
    Message message;
    if (const std::string mistake = parse_text(text, message); !mistake.empty()) {
      throw CLI::ValidationError(option, mistake);
    }
    for (const std::string& field : fields_of(message, "")) {
      if (field != "name") {
        changes.fields.push_back(field);
      }
    }
    changes.steps.push_back([message](Message& target) { target.MergeFrom(message); });
  };
  CLI::Option* text =
      add_text(verb, "--message", "TEXT", "protobuf text of the schema's " + Message().GetTypeName(),
               [take](const std::string& value) { take("--message", value); });
  add_text(verb, "--file", "FILE", "the same in a file", [take](const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) {
      throw CLI::ValidationError("--file", "cannot read " + path);
    }
    take("--file " + path, {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()});
  })->excludes(text);
}

// the name may also stand in --message
template <typename Message>
void add_name(CLI::App& verb, Changes<Message>& changes, const std::string& type, Editing editing) {
  verb.add_option_function<std::string>(
          "name",
          [&changes](const std::string& name) {
            changes.steps.push_back([name](Message& m) { m.set_name(name); });
          },
          "its name in the scene")
      ->type_name(editing == Editing::kSet ? type : "NAME");
  verb.parse_complete_callback([&changes, editing] {
    if (changes.applied_to({}).name().empty()) {
      throw CLI::RequiredError("name");
    }
    if (editing == Editing::kSet && changes.fields.empty()) {
      throw CLI::ValidationError("set", "nothing to set is told");
    }
  });
}

void exclude_each_other(const std::vector<CLI::Option*>& options) {
  for (CLI::Option* one : options) {
    for (CLI::Option* other : options) {
      if (one != other) {
        one->excludes(other);
      }
    }
  }
}

void add_shape_options(CLI::App& verb, Changes<v1::Object>& changes) {
  using v1::Object;
  const auto shape = [&changes](std::function<void(Object&)> step) { changes.add("shape", std::move(step)); };
  CLI::Option* box =
      add_numbers(verb, "--box", 3, "X Y Z", "a box of this size, m", [shape](const Numbers& size) {
        shape([size](Object& o) { *o.mutable_shape()->mutable_box()->mutable_size() = vector(size); });
      });
  CLI::Option* sphere =
      add_number(verb, "--sphere", "RADIUS", "a sphere of triangles, m", [shape](double radius) {
        shape([radius](Object& o) {
          o.mutable_shape()->mutable_icosphere()->set_radius(radius);
          o.mutable_shape()->mutable_icosphere()->set_subdivisions(3);
        });
      });
  add_count(verb, "--subdivisions", "of the sphere; default 3: 1280 triangles", [shape](std::uint32_t n) {
    shape([n](Object& o) { o.mutable_shape()->mutable_icosphere()->set_subdivisions(n); });
  })->needs(sphere);
  CLI::Option* cylinder = add_numbers(verb, "--cylinder", 2, "RADIUS HEIGHT", "a cylinder along z, m",
                                      [shape](const Numbers& size) {
                                        shape([size](Object& o) {
                                          v1::Shape::Cylinder& made = *o.mutable_shape()->mutable_cylinder();
                                          made.set_radius(size.at(0));
                                          made.set_height(size.at(1));
                                          made.set_segments(32);
                                        });
                                      });
  add_count(verb, "--segments", "of the cylinder; default 32", [shape](std::uint32_t n) {
    shape([n](Object& o) { o.mutable_shape()->mutable_cylinder()->set_segments(n); });
  })->needs(cylinder);
  exclude_each_other({box, sphere, cylinder});
}

void add_dynamic_options(CLI::App& verb, Changes<v1::Object>& changes, Editing editing) {
  using v1::Object;
  CLI::Option* dynamic = verb.add_flag_callback(
      "--dynamic", [&changes] { changes.add("dynamic", [](Object& o) { o.mutable_dynamic(); }); },
      "it moves; otherwise it is fixed in the world");
  if (editing == Editing::kSet) {
    verb.add_flag_callback(
            "--fixed", [&changes] { changes.add("dynamic", [](Object& o) { o.clear_dynamic(); }); },
            "it is fixed in the world")
        ->excludes(dynamic);
  }
  const auto number = [&](const std::string& option, const std::string& type, const std::string& field,
                          const std::string& help, void (Object::Dynamic::*set)(double)) {
    add_number(verb, option, type, help, [&changes, field, set](double value) {
      changes.add("dynamic." + field, [set, value](Object& o) { (o.mutable_dynamic()->*set)(value); });
    });
  };
  number("--linear-viscosity", "NS/M", "linear_viscosity", "N s/m; makes it dynamic",
         &Object::Dynamic::set_linear_viscosity);
  number("--angular-viscosity", "NMS/RAD", "angular_viscosity", "N m s/rad; makes it dynamic",
         &Object::Dynamic::set_angular_viscosity);
  number("--release-after", "SECONDS", "release_after", "fixed for so long first; makes it dynamic",
         &Object::Dynamic::set_release_after);
}

}  // namespace

void add_pose_options(CLI::App& verb, const PoseEditor& edit) {
  add_numbers(verb, "--at", 3, "X Y Z", "where its origin is, m", [edit](const Numbers& at) {
    edit([at](v1::Pose& pose) { *pose.mutable_position() = vector(at); });
  });
  add_numbers(verb, "--turn", 4, "W X Y Z", "how it is turned: a quaternion", [edit](const Numbers& turn) {
    edit([turn](v1::Pose& pose) {
      pose.mutable_orientation()->set_w(turn.at(0));
      pose.mutable_orientation()->set_x(turn.at(1));
      pose.mutable_orientation()->set_y(turn.at(2));
      pose.mutable_orientation()->set_z(turn.at(3));
    });
  });
}

void add_object_options(CLI::App& verb, Changes<v1::Object>& changes, Editing editing) {
  using v1::Object;
  add_message_options(verb, changes);
  add_name(verb, changes, "OBJECT", editing);
  add_shape_options(verb, changes);
  add_text(verb, "--inside", "MATERIAL", "what it is made of", [&changes](const std::string& name) {
    changes.add("inside", [name](Object& o) { o.set_inside(name); });
  });
  add_text(verb, "--outside", "MATERIAL", "of the layer of cells around it",
           [&changes](const std::string& name) {
             changes.add("outside", [name](Object& o) { o.set_outside(name); });
           });
  add_number(verb, "--air-margin", "METRES", "how thick that layer is", [&changes](double margin) {
    changes.add("air_margin", [margin](Object& o) { o.set_air_margin(margin); });
  });
  if (editing == Editing::kAdd) {
    add_pose_options(verb, [&changes](const PoseChange& change) {
      changes.add("pose", [change](Object& o) { change(*o.mutable_pose()); });
    });
  }
  add_dynamic_options(verb, changes, editing);
}

void add_material_options(CLI::App& verb, Changes<v1::Material>& changes, Editing editing) {
  using v1::Material;
  add_message_options(verb, changes);
  add_name(verb, changes, "MATERIAL", editing);
  add_number(verb, "--density", "KG/M^3", "counts for the mass of dynamic objects",
             [&changes](double density) {
               changes.add("density", [density](Material& m) { m.set_density(density); });
             });
  CLI::Option* free = verb.add_flag_callback(
      "--free", [&changes] { changes.add("free", [](Material& m) { m.mutable_free(); }); }, "no resistance");
  CLI::Option* rigid = add_numbers(verb, "--rigid", 2, "MU_S MU_K", "never entered; friction of its surface",
                                   [&changes](const Numbers& mu) {
                                     changes.add("rigid", [mu](Material& m) {
                                       m.mutable_rigid()->set_static_friction(mu.at(0));
                                       m.mutable_rigid()->set_kinetic_friction(mu.at(1));
                                     });
                                   });
  CLI::Option* yielding =
      add_number(verb, "--yielding", "FORCE", "entered by more than this force, N", [&changes](double force) {
        changes.add("yielding", [force](Material& m) { m.mutable_yielding()->set_force(force); });
      });
  add_number(verb, "--drag", "NS/M", "of what yields, N s/m", [&changes](double drag) {
    changes.add("yielding", [drag](Material& m) { m.mutable_yielding()->set_drag(drag); });
  })->needs(yielding);
  add_numbers(verb, "--friction", 2, "MU_S MU_K", "of the surface of what yields",
              [&changes](const Numbers& mu) {
                changes.add("yielding", [mu](Material& m) {
                  m.mutable_yielding()->set_static_friction(mu.at(0));
                  m.mutable_yielding()->set_kinetic_friction(mu.at(1));
                });
              })
      ->needs(yielding);
  CLI::Option* viscous = add_number(
      verb, "--viscous", "NS/M", "resists in proportion to velocity, N s/m", [&changes](double drag) {
        changes.add("viscous", [drag](Material& m) { m.mutable_viscous()->set_drag(drag); });
      });
  exclude_each_other({free, rigid, yielding, viscous});
}

void add_finger_options(CLI::App& verb, Changes<v1::Finger>& changes, Editing editing) {
  using v1::Finger;
  add_message_options(verb, changes);
  add_name(verb, changes, "FINGER", editing);
  add_text(verb, "--device", "DEVICE", "what it rides on", [&changes](const std::string& name) {
    changes.add("device", [name](Finger& f) { f.set_device(name); });
  });
  add_number(verb, "--stiffness", "N/M", "of each HIP", [&changes](double stiffness) {
    changes.add("stiffness", [stiffness](Finger& f) { f.set_stiffness(stiffness); });
  });
  CLI::Option* point = verb.add_flag_callback(
      "--point", [&changes] { changes.add("point", [](Finger& f) { f.mutable_point(); }); },
      "one HIP at the device's origin");
  CLI::Option* line =
      add_numbers(verb, "--line", 6, "X Y Z X Y Z", "HIPs from here to there, m, device frame",
                  [&changes](const Numbers& ends) {
                    changes.add("line", [ends](Finger& f) {
                      *f.mutable_line()->mutable_start() = vector(ends);
                      *f.mutable_line()->mutable_end() = vector(ends, 3);
                    });
                  });
  CLI::Option* tip = add_numbers(verb, "--fingertip", 2, "RADIUS ANGLE",
                                 "a spherical cap: m, half angle in rad", [&changes](const Numbers& cap) {
                                   changes.add("fingertip", [cap](Finger& f) {
                                     f.mutable_fingertip()->set_radius(cap.at(0));
                                     f.mutable_fingertip()->set_cap_angle(cap.at(1));
                                   });
                                 });
  add_numbers(verb, "--direction", 3, "X Y Z", "of the cap's pole, device frame",
              [&changes](const Numbers& pole) {
                changes.add("fingertip", [pole](Finger& f) {
                  *f.mutable_fingertip()->mutable_direction() = vector(pole);
                });
              })
      ->needs(tip);
  CLI::Option* hips_option =
      add_count(verb, "--hips", "how many on the line or the fingertip", [&changes](std::uint32_t hips) {
        changes.add("hips", [hips](Finger& f) {
          if (f.has_line()) {
            f.mutable_line()->set_hips(hips);
          } else {
            f.mutable_fingertip()->set_hips(hips);
          }
        });
      });
  hips_option->excludes(point);
  exclude_each_other({point, line, tip});
}

}  // namespace haptic::cli
