// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_tests_stencil_h
#define exemplar_tests_stencil_h

#include <exemplar/algebra/vector.h>

#include <utility>

namespace Exemplar::Testing
{
  /// The results of a function of one number near 0, for central differences of fourth order.
  template <typename Function>
  class Stencil
  {
  public:
    explicit Stencil(const Function &function, const double h = 1e-5)
        : h(h), results{ function(h), function(-h), function(2. * h), function(-2. * h) }
    {
    }

    /// The derivative of the number that `of` takes from a result.
    template <typename Of>
    double
    derivative(const Of &of) const
    {
      return (8. * (of(results[0]) - of(results[1])) - (of(results[2]) - of(results[3])))
             / (12. * h);
    }

    /// That of the gradient in a result.
    Vector
    derivative_of_gradient() const
    {
      Vector result(results[0].gradient.size());
      for (unsigned int dof = 0; dof < result.size(); ++dof)
        result[dof] = derivative([dof](const auto &at) { return at.gradient[dof]; });
      return result;
    }

  private:
    using Result = decltype(std::declval<Function>()(0.));

    const double h;
    const Result results[4];
  };

  /// By a variable that `evaluate` depends on.
  template <typename Evaluate>
  auto
  stencil_of(double &variable, const Evaluate &evaluate)
  {
    const double value = variable;
    const auto   at    = [&](const double h)
    {
      variable    = value + h;
      auto result = evaluate();
      variable    = value;
      return result;
    };
    return Stencil(at);
  }
} // namespace Exemplar::Testing

#endif
