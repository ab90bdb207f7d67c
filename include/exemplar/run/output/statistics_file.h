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

    /// Go on behind the first `n_bytes` of a file and forget the rest.
    StatisticsFile(const std::filesystem::path &path, std::uintmax_t n_bytes);

    /// Number of bytes up to the row of a step, which must be there, in the columns of `row`. If they were
    /// others, the file is replaced by these rows: columns that `row` has not are left out, and what
    /// earlier rows lack is empty.
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
