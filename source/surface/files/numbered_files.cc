// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/surface/files/numbered_files.h>

#include <algorithm>
#include <fnmatch.h>

namespace Exemplar
{
  namespace
  {
    namespace fs = std::filesystem;

    bool
    is_digit(const char c)
    {
      return c >= '0' && c <= '9';
    }

    /// Takes the digits at `position` without leading zeros, and goes behind them.
    std::string
    take_number(const std::string &text, std::size_t &position)
    {
      while (position < text.size() && text[position] == '0')
        ++position;
      const std::size_t begin = position;
      while (position < text.size() && is_digit(text[position]))
        ++position;
      return text.substr(begin, position - begin);
    }

    std::vector<fs::path>
    matches(const fs::path &pattern)
    {
      const fs::path        directory = pattern.has_parent_path() ? pattern.parent_path() : ".";
      std::vector<fs::path> files;
      std::error_code       none;
      for (const auto &entry : fs::directory_iterator(directory, none))
        if (fnmatch(pattern.filename().c_str(), entry.path().filename().c_str(), FNM_PERIOD) == 0)
          files.push_back(pattern.has_parent_path() ? entry.path() : entry.path().filename());
      std::sort(files.begin(), files.end(),
                [](const fs::path &a, const fs::path &b)
                { return comes_before(a.filename().string(), b.filename().string()); });
      return files;
    }
  } // namespace

  bool
  comes_before(const std::string &a, const std::string &b)
  {
    std::size_t i = 0, j = 0;
    while (i < a.size() && j < b.size())
      if (is_digit(a[i]) && is_digit(b[j]))
      {
        const std::string m = take_number(a, i), n = take_number(b, j);
        if (m != n)
          return m.size() != n.size() ? m.size() < n.size() : m < n;
      }
      else if (a[i] != b[j])
        return a[i] < b[j];
      else
      {
        ++i;
        ++j;
      }
    const bool both_end = i == a.size() && j == b.size(); // they differ by leading zeros at most
    return both_end ? a < b : i == a.size();
  }

  std::vector<fs::path>
  expand_patterns(const std::vector<std::string> &entries)
  {
    std::vector<fs::path> files;
    for (const std::string &entry : entries)
    {
      const bool is_pattern
          = fs::path(entry).filename().string().find_first_of("*?") != std::string::npos;
      if (!is_pattern || fs::exists(entry))
      {
        files.emplace_back(entry);
        continue;
      }
      const auto found = matches(entry);
      if (found.empty())
        throw UserError("No file matches " + entry
                        + ". In the file's name * stands for any characters and ? for one; "
                          "directories are taken as they are written.");
      files.insert(files.end(), found.begin(), found.end());
    }
    return files;
  }
} // namespace Exemplar
