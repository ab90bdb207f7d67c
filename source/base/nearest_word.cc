// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/nearest_word.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <numeric>
#include <utility>

namespace Exemplar
{
  namespace
  {
    constexpr std::size_t longest = 200; // longer words are not compared

    bool
    is_same(const char a, const char b)
    {
      return std::tolower(static_cast<unsigned char>(a))
             == std::tolower(static_cast<unsigned char>(b));
    }
    std::ptrdiff_t
    n_capitals(const std::string &word)
    {
      return std::count_if(word.begin(), word.end(),
                           [](const unsigned char c) { return std::isupper(c) != 0; });
    }
  } // namespace

  std::size_t
  edit_distance(const std::string &a, const std::string &b)
  {
    if (a.size() > longest || b.size() > longest)
      return std::max(a.size(), b.size());
    std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
    std::iota(d[0].begin(), d[0].end(), 0);
    for (std::size_t i = 1; i <= a.size(); ++i)
    {
      d[i][0] = i;
      for (std::size_t j = 1; j <= b.size(); ++j)
      {
        d[i][j] = std::min({ d[i - 1][j - 1] + (is_same(a[i - 1], b[j - 1]) ? 0 : 1),
                             d[i - 1][j] + 1, d[i][j - 1] + 1 });
        if (i > 1 && j > 1 && is_same(a[i - 1], b[j - 2]) && is_same(a[i - 2], b[j - 1]))
          d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
      }
    }
    return d[a.size()][b.size()];
  }

  bool
  is_near(const std::string &word, const std::string &other)
  {
    return edit_distance(word, other) <= (std::max(word.size(), other.size()) + 1) / 3;
  }

  std::string
  nearest_word(const std::string &word, const std::vector<std::string> &words)
  {
    const auto cost = [&](const std::string &other) {
      return std::pair(edit_distance(word, other), std::abs(n_capitals(word) - n_capitals(other)));
    };
    const auto nearest = std::min_element(words.begin(), words.end(),
                                          [&](const std::string &a, const std::string &b)
                                          { return cost(a) < cost(b); });
    return nearest != words.end() && is_near(word, *nearest) ? *nearest : "";
  }
} // namespace Exemplar
