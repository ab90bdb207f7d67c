// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/potential/friction_lag.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    constexpr std::size_t most_rounds = 6;
    /// Part of a difference that must be independent of newer ones.
    constexpr double least_independent = 1e-6;

    std::vector<double>
    difference(std::vector<double> of, const std::vector<double> &from)
    {
      of.resize(std::max(of.size(), from.size()));
      for (std::size_t i = 0; i < from.size(); ++i)
        of[i] -= from[i];
      return of;
    }
  } // namespace

  std::vector<double>
  FrictionLag::forces_by_row(const std::vector<Rubbing> &rubbing)
  {
    std::vector<double> result(rows.size());
    for (const Rubbing &at : rubbing)
    {
      const std::size_t row = rows.try_emplace({ at.obstacle, at.key }, rows.size()).first->second;
      result.resize(std::max(result.size(), row + 1));
      result[row] = at.force;
    }
    return result;
  }

  std::vector<double>
  FrictionLag::factors(const Exchange &exchange) const
  {
    const Round        &last = rounds.back();
    std::vector<double> rest = last.change;
    // an orthonormal basis of the differences, and what makes it of them
    std::vector<std::vector<double>> basis, of_differences;
    std::vector<double>              result;
    const auto product = [&](const std::vector<double> &a, const std::vector<double> &b)
    { return exchange.sum(dot(a, b)); };
    for (std::size_t k = rounds.size() - 1; k-- > 0;)
    {
      std::vector<double> vector = difference(last.change, rounds[k].change);
      vector.resize(rest.size());
      std::vector<double> made(basis.size() + 1);
      made.back()        = 1.;
      const double whole = std::sqrt(product(vector, vector));
      for (std::size_t j = 0; j < basis.size(); ++j)
      {
        const double part = product(vector, basis[j]);
        add(vector, -part, basis[j]);
        for (std::size_t i = 0; i < of_differences[j].size(); ++i)
          made[i] -= part * of_differences[j][i];
      }
      const double norm = std::sqrt(product(vector, vector));
      if (!(norm > least_independent * whole))
        break;
      for (double &entry : vector)
        entry /= norm;
      for (double &entry : made)
        entry /= norm;
      const double part = product(rest, vector);
      add(rest, -part, vector);
      result.push_back(0.);
      for (std::size_t i = 0; i < made.size(); ++i)
        result[i] += part * made[i];
      basis.push_back(std::move(vector));
      of_differences.push_back(std::move(made));
    }
    return result;
  }

  void
  FrictionLag::accelerate(const std::vector<Rubbing> &before,
                          std::vector<Rubbing>       &now,
                          const Exchange             &exchange)
  {
    const std::vector<double> led_here = forces_by_row(before), found = forces_by_row(now);
    rounds.push_back({ found, difference(found, led_here) });
    if (rounds.size() > most_rounds)
      rounds.pop_front();
    for (Round &round : rounds)
    {
      round.found.resize(rows.size());
      round.change.resize(rows.size());
    }
    std::vector<double>       next   = rounds.back().found;
    const std::vector<double> factor = factors(exchange);
    for (std::size_t j = 0; j < factor.size(); ++j)
      add(next, -factor[j], difference(rounds.back().found, rounds[rounds.size() - 2 - j].found));
    for (Rubbing &at : now)
      at.force = std::max(0., next[rows.at({ at.obstacle, at.key })]);
  }
} // namespace Exemplar
