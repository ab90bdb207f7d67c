// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/atomic_file.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/text_file.h>
#include <exemplar/run/output/statistics_file.h>

#include <fmt/core.h>

#include <algorithm>
#include <stdexcept>

namespace Exemplar
{
  namespace
  {
    /// Cut a file after its first `n_bytes`, those that belong to a checkpoint.
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

    CsvRow
    texts_of(const StatisticsRow &row)
    {
      CsvRow texts;
      for (const StatisticsCell &cell : row)
        texts.emplace_back(cell.column, cell.text());
      return texts;
    }

    /// Cells of a line of a table without quoted commas.
    std::vector<std::string>
    cells_in(const std::string &line)
    {
      std::vector<std::string> cells;
      std::size_t              begin = 0;
      for (std::size_t end; (end = line.find(',', begin)) != std::string::npos; begin = end + 1)
        cells.push_back(line.substr(begin, end - begin));
      cells.push_back(line.substr(begin));
      return cells;
    }

    struct EarlierRows
    {
      std::vector<std::string> columns, lines;
      std::uintmax_t           n_bytes = 0; ///< of all these lines
    };

    /// Read the rows up to that of a step.
    EarlierRows
    read_up_to(const std::filesystem::path &path, const unsigned int step)
    {
      std::ifstream in(path, std::ios::binary);
      std::string   line;
      EarlierRows   rows;
      bool          found = false;
      while (!found && std::getline(in, line) && !in.eof())
      {
        rows.n_bytes += line.size() + 1;
        if (rows.columns.empty())
          rows.columns = cells_in(line);
        else
        {
          rows.lines.push_back(line);
          found = line.substr(0, line.find(',')) == fmt::format("{}", step);
        }
      }
      if (!found)
        throw UserError(fmt::format(
            "{} has no row of step {}. Run the scene from its start, without --resume-from.",
            path.string(), step));
      return rows;
    }
  } // namespace

  std::uintmax_t
  StatisticsFile::keep_rows(const std::filesystem::path &path,
                            const unsigned int           step,
                            const StatisticsRow         &row)
  {
    const EarlierRows        earlier = read_up_to(path, step);
    std::vector<std::string> wanted;
    for (const StatisticsCell &cell : row)
      wanted.push_back(cell.column);
    if (earlier.columns == wanted)
      return earlier.n_bytes;
    AtomicFile file(path);
    write_csv_header(file.stream(), texts_of(row));
    for (const std::string &line : earlier.lines)
    {
      const std::vector<std::string> cells = cells_in(line);
      CsvRow                         kept  = texts_of(row);
      for (auto &[column, cell] : kept)
      {
        const auto at = static_cast<std::size_t>(
            std::find(earlier.columns.begin(), earlier.columns.end(), column)
            - earlier.columns.begin());
        cell = at < cells.size() ? cells[at] : "";
      }
      write_csv_cells(file.stream(), kept);
    }
    file.commit();
    return std::filesystem::file_size(path);
  }

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
      write_csv_header(out, texts_of(row));
    has_header = true;
    write_csv_cells(out, texts_of(row));
    out.flush();
    if (!out)
      throw std::runtime_error(path.string() + " cannot be written; is the disk full?");
  }
} // namespace Exemplar
