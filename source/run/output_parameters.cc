// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/prm/prm_tools.h>
#include <exemplar/run/output_parameters.h>

namespace Exemplar
{
  namespace
  {
    const EnumTable<FrameFormat> frame_formats = { { FrameFormat::vtu, "vtu" } };
  } // namespace

  void
  OutputParameters::declare(dealii::ParameterHandler &prm)
  {
    prm.enter_subsection("Output");
    prm.add_parameter("Directory", directory,
                      "Where results go, relative to the working directory; empty: "
                      "output/NAME of the scene file. An earlier run's files are cleared.");
    prm.add_parameter("Every", every,
                      "A frame every so many steps, and of the last; 0: none (final.msh alone).",
                      dealii::Patterns::Integer(0));
    declare_enum(prm, "Formats", format, frame_formats, "Format of the frames.");
    prm.add_parameter("Checkpoint minutes", checkpoint_minutes,
                      "Minutes of run time between checkpoints. One is also written at the end and "
                      "on Ctrl-C.",
                      dealii::Patterns::Double(0.));
    prm.leave_subsection();
  }
} // namespace Exemplar
