// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_errors_h
#define exemplar_errors_h

#include <filesystem>
#include <stdexcept>
#include <string>

namespace Exemplar
{
  /// The input is wrong. The message says what, where, what is allowed and the
  /// remedy, in one paragraph; the program prints it and ends with status 1.
  class UserError : public std::runtime_error
  {
    using std::runtime_error::runtime_error;
  };

  /// The numbers failed (no convergence, indefinite matrix). What was computed
  /// so far stays on disk; the program ends with status 2.
  class SolverFailure : public std::runtime_error
  {
    using std::runtime_error::runtime_error;
  };

  /// Interrupted by Ctrl-C or SIGTERM; a checkpoint has been written. Status 130.
  class Interrupted : public std::runtime_error
  {
    using std::runtime_error::runtime_error;
  };

  /// Why a path cannot be used, in words for a message: the path and the system's reason.
  inline std::string
  trouble_with_path(const std::filesystem::filesystem_error &error)
  {
    return error.path1().string() + ": " + error.code().message();
  }
} // namespace Exemplar

#endif
