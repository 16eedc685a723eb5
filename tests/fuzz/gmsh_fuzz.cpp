// Gmsh files, ASCII and binary: read into a sound mesh, or refused; and the complex takes it, or refuses it.

#include <cstddef>
#include <cstdint>

#include "tests/support/expect_sound_mesh.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace haptic;
  try {
    const load::LoadedMesh loaded = load::parse_gmsh({reinterpret_cast<const char*>(data), size}, "f");
    test::expect_sound_mesh(loaded);
    engine::CellComplex::build(loaded.mesh);
  } catch (const load::LoadError&) {
    return 0;
  } catch (const engine::MeshError&) {
    return 0;
  }
  return 0;
}
