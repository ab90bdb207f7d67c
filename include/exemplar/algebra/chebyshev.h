// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_chebyshev_h
#define exemplar_chebyshev_h

namespace Exemplar
{
  /// Factors of Chebyshev's iteration for a spectrum in [minimum, maximum]: each update is `keep`
  /// times the last update plus `take` times the preconditioned residual.
  class ChebyshevFactors
  {
  public:
    ChebyshevFactors(const double minimum, const double maximum)
        : center(0.5 * (maximum + minimum)), radius(0.5 * (maximum - minimum)),
          rho(radius / center), take(1. / center)
    {
    }

    void
    advance()
    {
      const double next = 1. / (2. * center / radius - rho);
      keep              = next * rho;
      take              = 2. * next / radius;
      rho               = next;
    }

  private:
    double center, radius, rho;

  public:
    double keep = 0., take;
  };
} // namespace Exemplar

#endif
