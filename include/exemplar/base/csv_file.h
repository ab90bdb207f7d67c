// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_csv_file_h
#define exemplar_csv_file_h

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace Exemplar
{
  /// A line of a table in CSV.
  struct CsvLine
  {
    std::size_t              number; ///< in the file, from 1
    std::vector<std::string> cells;  ///< without blanks around them and without quotes
  };

  /// Cells of a line, separated by commas outside of double quotes.
  std::vector<std::string>
  csv_cells(const std::string &line);

  /// Whether a cell is a number, finite or not.
  bool
  is_number(const std::string &cell);

  /// The lines of a table that are neither empty nor comments, which begin with #. The file should be `what`.
  /// Throws UserError for a file that cannot be read or is UTF-16, and for other separators than commas.
  std::vector<CsvLine>
  read_csv_file(const std::filesystem::path &file, const std::string &what);
} // namespace Exemplar

#endif
