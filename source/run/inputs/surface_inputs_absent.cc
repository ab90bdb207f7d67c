// SPDX-License-Identifier: GPL-3.0-or-later
// Stubs in place of surface_inputs.cc in the build of ./demo.sh.
#include <exemplar/base/errors.h>
#include <exemplar/base/whole_program.h>
#include <exemplar/run/inputs/surface_inputs.h>

namespace Exemplar
{
  namespace
  {
    [[noreturn]] void
    refuse_surface()
    {
      throw UserError("Mesh/File is a surface, and this build runs scenes on tetrahedra alone. "
                      + std::string(build_whole_program) + ".");
    }
  } // namespace

  struct SurfaceInputs::Poses
  {
  };

  SurfaceInputs::SurfaceInputs(const SceneParameters &scene, Announce announce)
      : scene(scene), announce(std::move(announce))
  {
  }

  SurfaceInputs::~SurfaceInputs() = default;

  void
  SurfaceInputs::read_pose(const std::string &)
  {
    refuse_surface();
  }

  MshFile
  SurfaceInputs::make_mesh()
  {
    refuse_surface();
  }

  std::vector<dealii::Point<3>>
  SurfaceInputs::carry(const std::string &, const MshFile &)
  {
    refuse_surface();
  }
} // namespace Exemplar
