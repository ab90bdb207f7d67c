// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/base/words.h>
#include <exemplar/body/orthotropy.h>
#include <exemplar/kernels/symmetric.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace Exemplar
{
  namespace
  {
    Matrix3<double>
    inverse(const Matrix3<double> &A)
    {
      const Matrix3<double> cofactor = cofactors(A); // symmetric like A
      return combine(1. / determinant(A), cofactor, 0., cofactor);
    }

    double
    sum_of_entries(const Matrix3<double> &A)
    {
      double sum = 0.;
      for (const auto &row : A.value)
        for (const double entry : row)
          sum += entry;
      return sum;
    }

    double
    min_eigenvalue(const Matrix3<double> &A)
    {
      const Vector3<double> values = symmetric_eigensystem(A).values;
      return std::min({ values[0], values[1], values[2] });
    }

    using Axis = std::array<double, 3>;

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

    Axis
    cross(const Axis &a, const Axis &b)
    {
      return { { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                 a[0] * b[1] - a[1] * b[0] } };
    }
  } // namespace

  Orthotropy::Orthotropy(const CellMaterial<double> &material, const double fibre_stiffness)
      : shear{ { material.mu, material.mu, material.mu } }
  {
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        normal[a][b] = material.lambda + (a == b ? 2. * material.mu : 0.);
    normal[0][0] += fibre_stiffness;
  }

  Orthotropy::Orthotropy(const std::array<double, 9> &constants,
                         const double                 fibre_stiffness,
                         const std::string           &key)
      : shear{ { constants[6], constants[7], constants[8] } }
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
    normal = inverse(compliance);
    normal[0][0] += fibre_stiffness;
  }

  CellMaterial<double>
  Orthotropy::isotropic_part() const
  {
    const double of_traces = sum_of_entries(normal);
    const double of_all    = trace(normal) + 2. * (shear[0] + shear[1] + shear[2]);
    const double mu        = (3. * of_all - of_traces) / 30.;
    return { of_traces / 9. - 2. / 3. * mu, mu };
  }

  double
  Orthotropy::least() const
  {
    return std::min({ 0.5 * min_eigenvalue(normal), shear[0], shear[1], shear[2] });
  }

  double
  Orthotropy::lambda_of_patches() const
  {
    const double bulk = 1. / sum_of_entries(inverse(normal));
    // C on deviatoric strains, in an orthonormal basis of those without shear
    const double          s = std::sqrt(0.5), t = std::sqrt(1. / 6.);
    const Vector3<double> basis[2] = { { { s, -s, 0. } }, { { t, t, -2. * t } } };
    double                A[2][2];
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j)
        A[i][j] = dot(basis[i], normal * basis[j]);
    const double mean   = 0.5 * (A[0][0] + A[1][1]);
    const double radius = std::hypot(0.5 * (A[0][0] - A[1][1]), A[0][1]);
    const double mu_min = std::min({ 0.5 * (mean - radius), shear[0], shear[1], shear[2] });
    return bulk - 2. / 3. * mu_min;
  }

  double
  Orthotropy::norm_of_grain() const
  {
    double maximum = 0.;
    for (int a = 0; a < 3; ++a)
      maximum = std::max({ maximum, std::abs(normal[a][a] - normal[(a + 1) % 3][(a + 1) % 3]),
                           2. * std::abs(shear[a] - shear[(a + 1) % 3]) });
    return maximum;
  }

  std::array<double, 3>
  Orthotropy::strain_of_pressure() const
  {
    const Matrix3<double> compliance = inverse(normal);
    std::array<double, 3> strain;
    for (int a = 0; a < 3; ++a)
      strain[a]
          = (compliance[a][0] + compliance[a][1] + compliance[a][2]) / sum_of_entries(compliance);
    return strain;
  }

  std::array<double, 3>
  Orthotropy::strain_of_tension() const
  {
    const Matrix3<double> compliance = inverse(normal);
    return { { 1., compliance[1][0] / compliance[0][0], compliance[2][0] / compliance[0][0] } };
  }

  Orthotropy
  Orthotropy::without(const double lambda) const
  {
    Orthotropy rest = *this;
    for (auto &row : rest.normal.value)
      for (double &entry : row)
        entry -= lambda;
    return rest;
  }

  namespace
  {
    /// All three axes; arbitrary ones for isotropic cells, which store none.
    std::array<Axis, 3>
    complete(const GrainAxes &axes)
    {
      const bool is_any = axes.along == GrainAxes().along;
      const Axis along  = is_any ? Axis{ { 1., 0., 0. } } : axes.along;
      const Axis across = is_any ? Axis{ { 0., 1., 0. } } : axes.across;
      return { { along, across, cross(along, across) } };
    }

    /// Product with a symmetric matrix of the tensor that has these normal and shear blocks in
    /// these axes.
    Matrix3<double>
    product(const Matrix3<double>       &normal,
            const std::array<double, 3> &twice_shear,
            const GrainAxes             &axes,
            const Matrix3<double>       &E)
    {
      const std::array<Axis, 3> all = complete(axes);
      Matrix3<double>           Q, P; // Q has the axes as rows, P as columns
      for (int a = 0; a < 3; ++a)
        for (int i = 0; i < 3; ++i)
          P[i][a] = Q[a][i] = all[a][i];
      const Matrix3<double> of_axes = Q * E * P;
      Matrix3<double>       T{};
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
        {
          T[a][a] += normal[a][b] * of_axes[b][b];
          if (a != b)
            T[a][b] = twice_shear[3 - a - b] * of_axes[a][b];
        }
      return P * T * Q;
    }
  } // namespace

  Orthotropy
  Orthotropy::sum(const double a, const double b, const Orthotropy &other) const
  {
    Orthotropy result;
    result.normal = combine(a, normal, b, other.normal);
    for (int i = 0; i < 3; ++i)
      result.shear[i] = a * shear[i] + b * other.shear[i];
    return result;
  }

  Matrix3<double>
  Orthotropy::stress(const GrainAxes &axes, const Matrix3<double> &E) const
  {
    return product(normal, { { 2. * shear[0], 2. * shear[1], 2. * shear[2] } }, axes, E);
  }

  Matrix3<double>
  Orthotropy::strain(const GrainAxes &axes, const Matrix3<double> &T) const
  {
    return product(inverse(normal), { { 0.5 / shear[0], 0.5 / shear[1], 0.5 / shear[2] } }, axes,
                   T);
  }

  std::array<double, 21>
  Orthotropy::entries(const GrainAxes &axes) const
  {
    const std::array<Axis, 3> q = complete(axes);
    SymmetricEntries<double>  squares[3], shears[3];
    for (int a = 0; a < 3; ++a)
    {
      squares[a] = dyad(q[a], q[a], true);
      shears[a]  = dyad(q[(a + 1) % 3], q[(a + 2) % 3], false);
    }
    std::array<double, 21> C{};
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
