// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_output_parameters_h
#define exemplar_output_parameters_h

#include <string>

namespace Exemplar
{
  class KeyTable;

  enum class FrameFormat
  {
    vtu
  };

  /// Subsection Output.
  struct OutputParameters
  {
    std::string  directory;
    unsigned int every              = 1;
    FrameFormat  format             = FrameFormat::vtu;
    double       checkpoint_minutes = 5.;

    void
    declare(KeyTable &keys);
  };
} // namespace Exemplar

#endif
