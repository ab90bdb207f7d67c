// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/text_file.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

namespace Exemplar
{
  namespace
  {
    std::string
    csv_cell(const std::string &text)
    {
      if (text.find_first_of(",\"\n") == std::string::npos)
        return text;
      std::string cell = "\"";
      for (const char c : text)
        cell += c == '"' ? "\"\"" : std::string(1, c);
      return cell + "\"";
    }
  } // namespace

  std::optional<std::string>
  read_text_file(const std::filesystem::path &file, std::string *reason)
  {
    errno = 0;
    std::ifstream in(file, std::ios::binary);
    if (!in || std::filesystem::is_directory(file)) // a directory opens, but does not read
    {
      if (reason != nullptr)
        *reason = errno != 0 ? std::strerror(errno) : "is it a directory?";
      return std::nullopt;
    }
    std::ostringstream bytes;
    bytes << in.rdbuf();
    return bytes.str();
  }

  void
  write_csv_header(std::ostream &out, const CsvRow &row)
  {
    for (std::size_t i = 0; i < row.size(); ++i)
      out << (i == 0 ? "" : ",") << csv_cell(row[i].first);
    out << '\n';
  }

  void
  write_csv_cells(std::ostream &out, const CsvRow &row)
  {
    for (std::size_t i = 0; i < row.size(); ++i)
      out << (i == 0 ? "" : ",") << csv_cell(row[i].second);
    out << '\n';
  }
} // namespace Exemplar
