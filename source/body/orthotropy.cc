// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/base/words.h>
#include <exemplar/body/orthotropy.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace Exemplar
{
  namespace
  {
    double
    min_eigenvalue(const Matrix3<double> &A)
    {
      const Vector3<double> values = symmetric_eigensystem(A).values;
      return std::min({ values[0], values[1], values[2] });
    }

    using Axis = GrainAxes::Axis;

    /// The entries of a b^T + b a^T, or of a a^T.
    SymmetricEntries<double>
    dyad(const Axis &a, const Axis &b, const bool is_same)
    {
      Matrix3<double> M;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          M[i][j] = is_same ? a[i] * a[j] : a[i] * b[j] + b[i] * a[j];
      return pack(M);
    }
  } // namespace

  Orthotropy<double>
  orthotropy_of(const std::array<double, 9> &constants,
                const double                 fibre_stiffness,
                const std::string           &key)
  {
    const double *E = constants.data(), *nu = E + 3;
    for (const std::size_t k : { 0, 1, 2, 6, 7, 8 })
      if (!(constants[k] > 0.))
        throw UserError(
            fmt::format("{}: the {}. number is {}, but E_1, E_2, E_3 and G_23, G_13, G_12 must "
                        "be greater than 0.",
                        key, k + 1, shortest_text(constants[k])));
    Matrix3<double> compliance;
    for (int a = 0; a < 3; ++a)
      for (int b = a; b < 3; ++b)
        compliance[a][b] = compliance[b][a] = a == b ? 1. / E[a] : -nu[3 - a - b] / E[a];
    if (const double minimum = min_eigenvalue(compliance); !(minimum > 1e-12 * trace(compliance)))
      throw UserError(
          key
          + " makes no elastic material: some strain without shear would give "
            "energy back, as the Poisson's ratios are too large for these E. Each nu_ab must be "
            "less than the square root of E_a / E_b, and 2 nu_12 nu_23 nu_13 E_3 / E_1 less "
            "than 1 - nu_12^2 E_2 / E_1 - nu_23^2 E_3 / E_2 - nu_13^2 E_3 / E_1. Lower them.");
    Matrix3<double> normal = inverse_of_symmetric(compliance);
    normal[0][0] += fibre_stiffness;
    return { normal, { { constants[6], constants[7], constants[8] } } };
  }

  template <typename Number>
  Number
  Orthotropy<Number>::least() const
  {
    return std::min({ 0.5 * min_eigenvalue(normal), shear[0], shear[1], shear[2] });
  }

  template <typename Number>
  Number
  Orthotropy<Number>::norm_of_grain() const
  {
    Number maximum = 0.;
    for (int a = 0; a < 3; ++a)
      maximum = std::max({ maximum, std::abs(normal[a][a] - normal[(a + 1) % 3][(a + 1) % 3]),
                           2. * std::abs(shear[a] - shear[(a + 1) % 3]) });
    return maximum;
  }

  template <typename Number>
  std::array<Number, 21>
  Orthotropy<Number>::entries(const GrainAxes &axes) const
  {
    const std::array<Axis, 3> q = axes.complete();
    SymmetricEntries<double>  squares[3], shears[3];
    for (int a = 0; a < 3; ++a)
    {
      squares[a] = dyad(q[a], q[a], true);
      shears[a]  = dyad(q[(a + 1) % 3], q[(a + 2) % 3], false);
    }
    std::array<Number, 21> C{};
    std::size_t            k = 0;
    for (std::size_t i = 0; i < n_symmetric; ++i)
      for (std::size_t j = i; j < n_symmetric; ++j, ++k)
        for (int a = 0; a < 3; ++a)
        {
          C[k] += shear[a] * shears[a][i] * shears[a][j];
          for (int b = 0; b < 3; ++b)
            C[k] += normal[a][b] * squares[a][i] * squares[b][j];
        }
    return C;
  }

  template class Orthotropy<double>;

  std::array<double, 9>
  parse_orthotropy(const std::string &text, const std::string &key)
  {
    const std::vector<std::string> words = split_trimmed(text, ',');
    std::array<double, 9>          constants;
    bool                           are_numbers = words.size() == constants.size();
    for (std::size_t k = 0; are_numbers && k < constants.size(); ++k)
    {
      constants[k] = parse_number(words[k]);
      are_numbers  = std::isfinite(constants[k]);
    }
    if (!are_numbers)
      throw UserError(
          key + " = '" + text
          + "' is not understood. Allowed: nine numbers separated by commas, E_1, E_2, E_3, "
            "nu_23, nu_13, nu_12, G_23, G_13, G_12, the first axis along Fibre direction "
            "and the second along Cross direction; or nothing.");
    return constants;
  }
} // namespace Exemplar
