// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/parts_of_graph.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace Exemplar
{
  namespace
  {
    constexpr unsigned int nowhere = static_cast<unsigned int>(-1);

    /// A bump with less than this of each quantity is no part of its own.
    constexpr double least_content = 0.05;

    /// Nodes with less than this of the greatest density have none: a thousandth of its amplitude.
    constexpr double negligible_density = 1e-6;

    /// The neighbours of each node.
    struct Neighbours
    {
      Neighbours(const std::vector<std::array<unsigned int, 2>> &edges, const std::size_t n)
          : of_node(n)
      {
        for (const auto &[a, b] : edges)
        {
          of_node[a].push_back(b);
          of_node[b].push_back(a);
        }
      }

      std::vector<std::vector<unsigned int>> of_node;
    };

    /// The greatest density of a node, and of which quantity it is.
    struct Height
    {
      double       value    = 0.;
      unsigned int quantity = 0;
    };

    std::vector<Height>
    heights_of(const std::vector<std::vector<double>> &densities, const std::size_t n)
    {
      std::vector<Height> heights(n);
      for (unsigned int quantity = 0; quantity < densities.size(); ++quantity)
        for (std::size_t node = 0; node < n; ++node)
          if (densities[quantity][node] > heights[node].value)
            heights[node] = { densities[quantity][node], quantity };
      return heights;
    }

    /// The nodes with a height that counts, the highest first.
    std::vector<unsigned int>
    from_above(const std::vector<Height> &heights)
    {
      double top = 0.;
      for (const Height &height : heights)
        top = std::max(top, height.value);
      std::vector<unsigned int> order;
      for (unsigned int node = 0; node < heights.size(); ++node)
        if (heights[node].value > negligible_density * top)
          order.push_back(node);
      std::stable_sort(order.begin(), order.end(),
                       [&](const unsigned int a, const unsigned int b)
                       { return heights[a].value > heights[b].value; });
      return order;
    }

    /// The bump of each node; nowhere for nodes without height.
    std::vector<unsigned int>
    watershed(const std::vector<Height> &heights, const Neighbours &neighbours)
    {
      std::vector<unsigned int> bump(heights.size(), nowhere);
      unsigned int              n = 0;
      for (const unsigned int node : from_above(heights))
      {
        unsigned int highest = nowhere;
        for (const unsigned int other : neighbours.of_node[node])
          if (bump[other] != nowhere && heights[other].quantity == heights[node].quantity
              && (highest == nowhere || heights[other].value > heights[highest].value))
            highest = other;
        bump[node] = highest == nowhere ? n++ : bump[highest];
      }
      return bump;
    }

    /// Nodes without a part get that of the nearest node with one; what is not connected to any is one part.
    void
    fill(std::vector<unsigned int> &part, const Neighbours &neighbours)
    {
      std::vector<unsigned int> front;
      for (unsigned int node = 0; node < part.size(); ++node)
        if (part[node] != nowhere)
          front.push_back(node);
      for (std::size_t next = 0; next < front.size(); ++next)
        for (const unsigned int other : neighbours.of_node[front[next]])
          if (part[other] == nowhere)
          {
            part[other] = part[front[next]];
            front.push_back(other);
          }
      const unsigned int apart = static_cast<unsigned int>(part.size()); // no bump has this number
      std::replace(part.begin(), part.end(), nowhere, apart);
    }

    /// The bumps and the passes between them, which join pair by pair.
    class Bumps
    {
    public:
      Bumps(const std::vector<unsigned int>                &bump,
            const std::vector<Height>                      &heights,
            const std::vector<std::array<unsigned int, 2>> &edges,
            const std::vector<double>                      &measures,
            const std::vector<std::vector<double>>         &densities)
      {
        for (const unsigned int of_node : bump)
          if (of_node != nowhere && of_node >= now.size())
            now.resize(of_node + 1);
        std::iota(now.begin(), now.end(), 0);
        peak.resize(now.size(), 0.);
        content.resize(now.size(), std::vector<double>(densities.size(), 0.));
        for (std::size_t node = 0; node < bump.size(); ++node)
          if (bump[node] != nowhere)
          {
            peak[bump[node]] = std::max(peak[bump[node]], heights[node].value);
            for (std::size_t quantity = 0; quantity < densities.size(); ++quantity)
              content[bump[node]][quantity] += measures[node] * densities[quantity][node];
          }
        for (const auto &[a, b] : edges)
          if (bump[a] != nowhere && bump[b] != nowhere && bump[a] != bump[b])
            raise({ bump[a], bump[b] }, std::min(heights[a].value, heights[b].value), passes);
      }

      void
      join(const double least_likeness)
      {
        while (!passes.empty())
        {
          const auto best                 = std::max_element(passes.begin(), passes.end(),
                                                             [&](const auto &a, const auto &b)
                                                             { return urgency(a) < urgency(b); });
          const auto [is_small, likeness] = urgency(*best);
          if (!is_small && likeness < least_likeness)
            return;
          join(best->first);
        }
      }

      /// What a bump of the watershed belongs to.
      unsigned int
      operator[](const unsigned int bump) const
      {
        return now[bump];
      }

    private:
      using Pair = std::pair<unsigned int, unsigned int>;

      static void
      raise(const Pair pair, const double height, std::map<Pair, double> &of)
      {
        double &pass = of[{ std::min(pair.first, pair.second), std::max(pair.first, pair.second) }];
        pass         = std::max(pass, height);
      }

      std::pair<bool, double>
      urgency(const std::pair<const Pair, double> &pass) const
      {
        const auto &[a, b] = pass.first;
        double of_a = 0., of_b = 0., of_both = 0., most_of_a = 0., most_of_b = 0.;
        for (std::size_t quantity = 0; quantity < content[a].size(); ++quantity)
        {
          of_a += content[a][quantity];
          of_b += content[b][quantity];
          of_both += std::sqrt(content[a][quantity] * content[b][quantity]);
          most_of_a = std::max(most_of_a, content[a][quantity]);
          most_of_b = std::max(most_of_b, content[b][quantity]);
        }
        return { std::min(most_of_a, most_of_b) < least_content,
                 std::sqrt(pass.second / std::min(peak[a], peak[b])) * of_both
                     / std::sqrt(of_a * of_b) };
      }

      void
      join(const Pair pair)
      {
        const auto [stays, goes] = pair;
        std::replace(now.begin(), now.end(), goes, stays);
        peak[stays] = std::max(peak[stays], peak[goes]);
        for (std::size_t quantity = 0; quantity < content[stays].size(); ++quantity)
          content[stays][quantity] += content[goes][quantity];
        std::map<Pair, double> renamed;
        for (const auto &[ends, height] : passes)
        {
          const Pair other{ ends.first == goes ? stays : ends.first,
                            ends.second == goes ? stays : ends.second };
          if (other.first != other.second)
            raise(other, height, renamed);
        }
        passes = std::move(renamed);
      }

      std::vector<unsigned int>        now; ///< the bump that stands for each
      std::vector<double>              peak;
      std::vector<std::vector<double>> content; ///< of each quantity
      std::map<Pair, double>           passes;  ///< heights of the highest passes
    };

    /// Number the parts by descending measure, those of equal measure by their first node.
    void
    renumber(std::vector<unsigned int> &part, const std::vector<double> &measures)
    {
      std::map<unsigned int, double> size;
      std::vector<unsigned int>      order;
      for (std::size_t node = 0; node < part.size(); ++node)
      {
        if (size.count(part[node]) == 0)
          order.push_back(part[node]);
        size[part[node]] += measures[node];
      }
      std::stable_sort(order.begin(), order.end(),
                       [&](const unsigned int a, const unsigned int b)
                       { return size[a] > size[b]; });
      std::map<unsigned int, unsigned int> number;
      for (const unsigned int old : order)
        number.emplace(old, static_cast<unsigned int>(number.size()));
      for (unsigned int &of_node : part)
        of_node = number[of_node];
    }
  } // namespace

  std::vector<unsigned int>
  parts_of_graph(const std::vector<std::array<unsigned int, 2>> &edges,
                 const std::vector<double>                      &measures,
                 const std::vector<std::vector<double>>         &densities,
                 const double                                    least_likeness)
  {
    const std::vector<Height> heights = heights_of(densities, measures.size());
    const Neighbours          neighbours(edges, measures.size());
    std::vector<unsigned int> part = watershed(heights, neighbours);
    Bumps                     bumps(part, heights, edges, measures, densities);
    bumps.join(least_likeness);
    for (unsigned int &of_node : part)
      if (of_node != nowhere)
        of_node = bumps[of_node];
    fill(part, neighbours);
    renumber(part, measures);
    return part;
  }
} // namespace Exemplar
