// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/words.h>

#include <sstream>

namespace Exemplar
{
  std::string
  counted(const std::size_t n, const std::string &noun)
  {
    return std::to_string(n) + " " + noun + (n == 1 ? "" : "s");
  }

  std::string
  trim(const std::string &text)
  {
    const auto first = text.find_first_not_of(" \t\r\n");
    if (first == std::string::npos)
      return "";
    return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
  }

  bool
  ends_with(const std::string &text, const std::string &end)
  {
    return text.size() >= end.size()
           && text.compare(text.size() - end.size(), end.size(), end) == 0;
  }

  std::vector<std::string>
  split_trimmed(const std::string &text, const char separator)
  {
    std::vector<std::string> parts;
    if (trim(text).empty())
      return parts;
    std::istringstream in(text);
    for (std::string part; std::getline(in, part, separator);)
      parts.push_back(trim(part));
    if (text.back() == separator)
      parts.emplace_back();
    return parts;
  }
} // namespace Exemplar
