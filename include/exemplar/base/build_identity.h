// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_build_identity_h
#define exemplar_build_identity_h

#include <string>

namespace Exemplar
{
  /// An identity of the program or shared library that holds `address`: the linker's digest of its
  /// contents (GNU build id), in hexadecimal digits. Where a linker has given it none, its path,
  /// size and time of change.
  std::string
  build_identity(const void *address);

  /// The build identity of this code, which changes with each change of the program.
  std::string
  own_build_identity();
} // namespace Exemplar

#endif
