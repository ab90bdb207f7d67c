// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_whole_program_h
#define exemplar_whole_program_h

namespace Exemplar
{
  /// The last sentence of errors about parts that ./demo.sh does not build (EXEMPLAR_SCENES_ONLY).
  constexpr const char *build_whole_program
      = "Build all of exemplar: cmake --preset release && cmake --build --preset release";
} // namespace Exemplar

#endif
