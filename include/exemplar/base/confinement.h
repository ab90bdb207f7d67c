// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_confinement_h
#define exemplar_confinement_h

#include <filesystem>
#include <string>
#include <vector>

namespace Exemplar
{
  /// Confines a process that is about to read untrusted files: it irrevocably gives up everything
  /// but computing, reading the system's files and `readable` (files, or directories with all in
  /// them), and using the files that are open. It starts no program, opens nothing to write,
  /// removes and renames nothing, opens no socket and signals no process but itself. Returns the
  /// kernel's mechanisms now in force: "seccomp", "landlock", both, or none where the kernel has
  /// neither.
  std::vector<std::string>
  confine_this_process(const std::vector<std::filesystem::path> &readable);
} // namespace Exemplar

#endif
