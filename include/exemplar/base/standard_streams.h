// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_standard_streams_h
#define exemplar_standard_streams_h

namespace Exemplar
{
  /// Protect files and computations from lost standard streams. A closed stream is opened on
  /// nothing: otherwise the next file opened would get its number, and the program's output would
  /// be written into it. Writing to a pipe whose reader has gone fails, where by default it ends
  /// the process. To be called before anything is opened.
  void
  secure_standard_streams();

  /// Throws UserError if output to standard output has been lost, because the disk is full, say. A
  /// reader that has gone is no error. For commands whose result is what they print.
  void
  require_printed();
} // namespace Exemplar

#endif
