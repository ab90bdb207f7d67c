// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_msh_node_index_h
#define exemplar_msh_node_index_h

#include <exemplar/mesh/msh_scanner.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace Exemplar
{
  /// Map from node numbers to indices. Nearly every file counts its nodes up from the first one, so
  /// that position is tried before searching.
  class NodeIndex
  {
  public:
    NodeIndex(const std::vector<std::size_t> &numbers, const MshScanner &scanner)
    {
      pairs.reserve(numbers.size());
      for (std::size_t i = 0; i < numbers.size(); ++i)
        pairs.emplace_back(numbers[i], i);
      std::sort(pairs.begin(), pairs.end());
      for (std::size_t i = 1; i < pairs.size(); ++i)
        if (pairs[i].first == pairs[i - 1].first)
          scanner.fail("node number " + std::to_string(pairs[i].first)
                       + " appears twice. Every node needs its own number: save the mesh anew.");
    }

    /// Writes the index of `number`; false if there is no such node.
    bool
    find(const std::size_t number, std::size_t &index) const
    {
      if (pairs.empty())
        return false;
      const std::size_t guess = number - pairs.front().first;
      const auto        pair  = (guess < pairs.size() && pairs[guess].first == number)
                                    ? pairs.begin() + static_cast<std::ptrdiff_t>(guess)
                                    : std::lower_bound(pairs.begin(), pairs.end(),
                                                       std::make_pair(number, std::size_t(0)));
      if (pair == pairs.end() || pair->first != number)
        return false;
      index = pair->second;
      return true;
    }

  private:
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
  };
} // namespace Exemplar

#endif
