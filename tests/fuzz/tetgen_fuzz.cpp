// TetGen's pairs, with a line "---" between .node and .ele: read into a sound mesh, or refused; and the
// complex takes it, or refuses it.

#include <cstddef>
#include <cstdint>

#include "tests/support/expect_sound_mesh.h"
#include "tests/support/tetgen_pair.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace haptic;
  const auto [nodes, cells] = test::split_tetgen_pair({reinterpret_cast<const char*>(data), size});
  try {
    const load::LoadedMesh loaded = load::parse_tetgen(nodes, "f.node", cells, "f.ele");
    test::expect_sound_mesh(loaded);
    engine::CellComplex::build(loaded.mesh);
  } catch (const load::LoadError&) {
    return 0;
  } catch (const engine::MeshError&) {
    return 0;
  }
  return 0;
}
