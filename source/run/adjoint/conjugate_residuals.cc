// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/adjoint/conjugate_residuals.h>

#include <cmath>

namespace Exemplar
{
  namespace
  {
    void
    add_to(Direction &sum, const double factor, const Direction &direction)
    {
      sum.positions.add(factor, direction.positions);
      for (std::size_t i = 0; i < sum.weights.size(); ++i)
        sum.weights[i] += factor * direction.weights[i];
    }

    void
    scale(Direction &direction, const double factor)
    {
      direction.positions *= factor;
      for (double &weight : direction.weights)
        weight *= factor;
    }
  } // namespace

  double
  ConjugateResiduals::product(const Direction &a, const Direction &b) const
  {
    double sum = a.positions * b.positions;
    for (std::size_t i = 0; i < a.weights.size(); ++i)
      sum += of_weights * of_weights * a.weights[i] * b.weights[i];
    return sum;
  }

  void
  ConjugateResiduals::add(Direction step, Direction image, Direction &solution, Direction &rest)
  {
    for (std::size_t k = 0; k < images.size(); ++k)
    {
      const double part = product(image, images[k]);
      add_to(image, -part, images[k]);
      add_to(step, -part, steps[k]);
    }
    const double norm = std::sqrt(product(image, image));
    if (!(norm > 0.))
      return;
    scale(image, 1. / norm);
    scale(step, 1. / norm);
    const double part = product(rest, image);
    add_to(solution, part, step);
    add_to(rest, -part, image);
    steps.push_back(std::move(step));
    images.push_back(std::move(image));
  }
} // namespace Exemplar
