// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_standard_streams_h
#define exemplar_standard_streams_h

namespace Exemplar
{
  /// Whatever becomes of standard input, output and error, no file and no computation suffers. One
  /// that is closed is opened on nothing: otherwise the next file that is opened would have its number, and
  /// what the program says would be written into it. Writing to a pipe whose reader has gone fails, where by
  /// default it ends the process. To be called before anything is opened.
  void
  secure_standard_streams();

  /// Throws UserError if something that was written to standard output has not arrived, because the disk is
  /// full, say. A reader that has gone has seen what it wanted. For commands whose result is what they print.
  void
  require_printed();
} // namespace Exemplar

#endif
