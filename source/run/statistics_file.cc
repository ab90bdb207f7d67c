// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/text_file.h>
#include <exemplar/run/statistics_file.h>

#include <stdexcept>

namespace Exemplar
{
  namespace
  {
    /// Cut a file behind its first bytes, those that belong to a checkpoint.
    std::filesystem::path
    truncated(const std::filesystem::path &path, const std::uintmax_t n_bytes)
    {
      std::error_code error;
      if (std::filesystem::file_size(path, error) < n_bytes || error)
        throw UserError(path.string()
                        + " is missing or shorter than at the checkpoint. Run the "
                          "scene without --resume.");
      std::filesystem::resize_file(path, n_bytes);
      return path;
    }
  } // namespace

  StatisticsFile::StatisticsFile(const std::filesystem::path &path)
      : path(path), out(path, std::ios::binary), has_header(false)
  {
  }

  StatisticsFile::StatisticsFile(const std::filesystem::path &path, const std::uintmax_t n_bytes)
      : path(path), out(truncated(path, n_bytes), std::ios::binary | std::ios::in | std::ios::ate),
        has_header(true)
  {
  }

  void
  StatisticsFile::write(const StatisticsRow &row)
  {
    if (!has_header)
      write_csv_header(out, row);
    has_header = true;
    write_csv_cells(out, row);
    out.flush();
    if (!out)
      throw std::runtime_error(path.string() + " cannot be written; is the disk full?");
  }
} // namespace Exemplar
