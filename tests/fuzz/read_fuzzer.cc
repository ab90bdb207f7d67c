// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/mesh/mesh.h>
#include <exemplar/mesh/mesh_generation.h>
#include <exemplar/mesh/mesh_inputs.h>
#include <exemplar/mesh/msh_file.h>
#include <exemplar/prm/expression.h>
#include <exemplar/run/scene/scene_file.h>
#include <exemplar/study/study_axes.h>

#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <functional>
#include <stdexcept>

// libFuzzer's target: the first byte of its input chooses a reader, the rest is what that reads. A reader may throw UserError,
// or SolverFailure for a formula that is not finite; any other exception ends the fuzzer, as does a sanitizer.
namespace Exemplar
{
  namespace
  {
    /// A file in memory with a path.
    class MemoryFile
    {
    public:
      explicit MemoryFile(const std::string &bytes) : descriptor(memfd_create("input", MFD_CLOEXEC))
      {
        if (write(descriptor, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size()))
          throw std::runtime_error("no memory for the input");
      }

      ~MemoryFile()
      {
        close(descriptor);
      }

      std::filesystem::path
      path() const
      {
        return "/proc/self/fd/" + std::to_string(descriptor);
      }

    private:
      const int descriptor;
    };

    void
    read_mesh(const std::string &bytes)
    {
      const Mesh mesh(read_msh(MemoryFile(bytes).path()), "mesh.msh");
    }

    void
    read_scene(const std::string &bytes)
    {
      const std::vector<std::string> no_overrides;
      const SceneFile                scene("", bytes, no_overrides);
    }

    void
    read_formulas(const std::string &bytes)
    {
      const Expression formulas("key", bytes, "xyzt", 3);
      formulas.values({ 1., 0., -0.5 }, 0.25);
    }

    void
    read_node_list(const std::string &bytes)
    {
      static const MshFile box = generate_box({ { 1., 1., 1. } }, { { 2, 1, 1 } });
      read_nodes(MemoryFile(bytes).path(), box, "box", "Select");
    }

    void
    read_study(const std::string &bytes)
    {
      parse_axes(bytes, "Vary");
      parse_settings(bytes, "Base");
    }

    void
    read(const std::uint8_t choice, const std::string &bytes)
    {
      const std::array<std::function<void(const std::string &)>, 5> readers{
        { read_mesh, read_scene, read_formulas, read_node_list, read_study }
      };
      try
      {
        readers[choice % readers.size()](bytes);
      }
      catch (const UserError &)
      {
      }
      catch (const SolverFailure &)
      {
      }
    }
  } // namespace
} // namespace Exemplar

extern "C" int
LLVMFuzzerTestOneInput(const std::uint8_t *data, const std::size_t size)
{
  if (size > 0)
    Exemplar::read(data[0], std::string(reinterpret_cast<const char *>(data) + 1, size - 1));
  return 0;
}
