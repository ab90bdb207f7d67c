// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/adjoint/adjoint_inverse.h>

#include <numeric>

namespace Exemplar
{
  void
  AdjointInverse::reinit(BorderedSystem &new_system,
                         const Vector   &positions,
                         const Exchange &exchange)
  {
    inverse.reset(); // its memory first
    system = &new_system;
    form   = &system->weight_form();
    system->factorize_roughly(positions);
    Z = system->columns();
    if (!Z.empty())
      system->apply_inverse(Z); // refined, as the Schur complement is a small difference
    const std::size_t n = form->coupled.empty() ? 0 : Z.size() / form->coupled.size();
    if (form->H.m() > 0)
      schur = make_schur_complement(*form, system->columns(), Z.data(), n, exchange);
    if (system->outer_products() == nullptr)
      inverse = system->keep();
  }

  void
  AdjointInverse::set_inactive(const std::vector<bool> &new_inactive)
  {
    const unsigned int k = form->H.m(), m = form->N.m();
    inactive = new_inactive;
    if (k == 0)
      return;
    const double size = schur.linfty_norm();
    of_weights.reinit(k + m, k + m);
    for (unsigned int i = 0; i < k; ++i)
    {
      for (unsigned int j = 0; j < k; ++j)
        of_weights(i, j) = inactive[i] && inactive[j] ? schur(i, j) : 0.;
      if (!inactive[i])
        of_weights(i, i) = size;
      for (unsigned int region = 0; region < m; ++region)
        of_weights(i, k + region) = of_weights(k + region, i)
            = inactive[i] ? size * form->N(region, i) : 0.;
    }
    of_weights.gauss_jordan();
  }

  void
  AdjointInverse::apply(BorderedVector &vector) const
  {
    const std::size_t         n = vector.positions.size();
    const std::vector<double> b = solve_weights(vector);
    if (inverse != nullptr)
      inverse->apply(vector.positions);
    else
      system->apply_inverse(vector.positions);
    for (std::size_t j = 0; j < form->coupled.size(); ++j)
      for (std::size_t i = 0; i < n && b[form->coupled[j]] != 0.; ++i)
        vector.positions[i] += b[form->coupled[j]] * Z[j * n + i];
    vector.weights = b;
  }

  std::vector<double>
  AdjointInverse::solve_weights(const BorderedVector &right_side) const
  {
    const unsigned int k = form->H.m();
    if (k == 0)
      return {};
    const auto             n = static_cast<std::ptrdiff_t>(right_side.positions.size());
    dealii::Vector<double> right(of_weights.m()), solution(of_weights.m());
    for (unsigned int weight = 0; weight < k; ++weight)
      right[weight] = inactive[weight] ? right_side.weights[weight] : 0.;
    for (std::size_t j = 0; j < form->coupled.size(); ++j)
      if (inactive[form->coupled[j]])
        right[form->coupled[j]] += std::inner_product(
            right_side.positions.begin(), right_side.positions.end(), Z.begin() + j * n, 0.);
    of_weights.vmult(solution, right);
    return { solution.begin(), solution.begin() + k };
  }
} // namespace Exemplar
