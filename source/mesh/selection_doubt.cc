// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/number_text.h>
#include <exemplar/mesh/selection.h>

#include <array>
#include <sstream>
#include <utility>

namespace Exemplar
{
  std::string
  Selection::doubt() const
  {
    std::istringstream         in(text);
    std::string                kind, more;
    std::array<std::string, 6> word;
    in >> kind;
    for (std::string &one : word)
      in >> one;
    const auto are_in_order = [&](const std::size_t first, const std::size_t second)
    { return parse_number(word[first]) <= parse_number(word[second]); };
    const bool are_corners = are_in_order(0, 3) && are_in_order(1, 4) && are_in_order(2, 5);
    const bool are_ranges  = are_in_order(0, 1) && are_in_order(2, 3) && are_in_order(4, 5);
    if (kind != "box" || !in || in >> more || are_corners || !are_ranges)
      return "";
    const auto box = [&](const std::array<std::size_t, 6> &order)
    {
      std::string result = "'box";
      for (const std::size_t i : order)
        result += " " + word[i];
      return result + "'";
    };
    std::array<std::size_t, 6> rising{ { 0, 1, 2, 3, 4, 5 } };
    for (std::size_t c = 0; c < 3; ++c)
      if (!are_in_order(c, c + 3))
        std::swap(rising[c], rising[c + 3]);
    const std::string ranges = box({ { 0, 2, 4, 1, 3, 5 } }), corners = box(rising);
    return ranges == corners ? ""
                             : "A box has two corners, x0 y0 z0 and x1 y1 z1. Did you mean "
                                   + ranges + "? If not, write " + corners + ".";
  }
} // namespace Exemplar
