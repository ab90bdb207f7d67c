// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_text_file_h
#define exemplar_text_file_h

#include <filesystem>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace Exemplar
{
  /// Why a file must not be read, in words for a message: a directory or a device, of which one
  /// like /dev/zero has no end. Empty for all else.
  std::string
  reason_not_to_read(const std::filesystem::path &file);

  /// All bytes of a file; no value if it cannot be read, and then `reason`, if given, says why, in
  /// words for a message. Directories and devices cannot be read.
  std::optional<std::string>
  read_text_file(const std::filesystem::path &file, std::string *reason = nullptr);

  /// (column, cell) of a table in CSV, in the order of the columns.
  using CsvRow = std::vector<std::pair<std::string, std::string>>;

  /// Write a line of the columns' names, quoted where needed for CSV.
  void
  write_csv_header(std::ostream &out, const CsvRow &row);

  /// Write a line of the cells, quoted where needed for CSV.
  void
  write_csv_cells(std::ostream &out, const CsvRow &row);
} // namespace Exemplar

#endif
