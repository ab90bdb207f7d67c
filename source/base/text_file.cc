// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/text_file.h>

#include <cerrno>
#include <cstring>
#include <fstream>

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

  std::string
  reason_not_to_read(const std::filesystem::path &file)
  {
    std::error_code ignored;
    const auto      kind = std::filesystem::status(file, ignored).type();
    if (kind == std::filesystem::file_type::directory)
      return "it is a directory";
    if (kind == std::filesystem::file_type::character || kind == std::filesystem::file_type::block)
      return "it is a device";
    return "";
  }

  std::optional<std::string>
  read_text_file(const std::filesystem::path &file, std::string *reason)
  {
    const auto fail = [reason](const std::string &why)
    {
      if (reason != nullptr)
        *reason = why;
      return std::nullopt;
    };
    if (const std::string why = reason_not_to_read(file); !why.empty())
      return fail(why);
    errno = 0;
    std::ifstream in(file, std::ios::binary);
    if (!in)
      return fail(std::strerror(errno));
    std::string       bytes;
    std::vector<char> block(1 << 16);
    while (in.read(block.data(), block.size()) || in.gcount() > 0)
      bytes.append(block.data(), in.gcount());
    if (in.bad()) // otherwise a part would be taken for the whole
      return fail("reading it fails");
    return bytes;
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
