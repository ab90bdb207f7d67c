// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_statistics_file_h
#define exemplar_statistics_file_h

#include <exemplar/run/output/diagnostics.h>

#include <cstdint>
#include <filesystem>
#include <fstream>

namespace Exemplar
{
  /// statistics.csv: the columns of the first row as header, then a line a step. Each
  /// line is on disk when write() returns.
  class StatisticsFile
  {
  public:
    /// A new file.
    explicit StatisticsFile(const std::filesystem::path &path);

    /// Append after the first `n_bytes` of a file; the rest is cut off.
    StatisticsFile(const std::filesystem::path &path, std::uintmax_t n_bytes);

    /// Number of bytes up to the row of a step, which must exist, in the columns of `row`. If the
    /// file's columns differ, it is rewritten: columns that `row` lacks are dropped, and new ones
    /// are empty in earlier rows.
    static std::uintmax_t
    keep_rows(const std::filesystem::path &path, unsigned int step, const StatisticsRow &row);

    void
    write(const StatisticsRow &row);

    std::uintmax_t
    n_bytes()
    {
      return static_cast<std::uintmax_t>(out.tellp());
    }

  private:
    std::filesystem::path path;
    std::ofstream         out;
    bool                  has_header;
  };
} // namespace Exemplar

#endif
