// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_orthotropy_h
#define exemplar_orthotropy_h

#include <exemplar/kernels/elasticity.h>
#include <exemplar/kernels/symmetric.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace Exemplar
{
  /// Orthonormal material axes of a cell at rest: along the fibres, and the second axis of
  /// orthotropy. Zeros where no material needs them.
  struct GrainAxes
  {
    using Axis = std::array<double, 3>;

    Axis along  = { { 0., 0., 0. } };
    Axis across = { { 0., 0., 0. } };

    bool
    are_any() const
    {
      return along != GrainAxes().along;
    }

    /// All three axes; arbitrary ones for isotropic cells, which store none.
    std::array<Axis, 3>
    complete() const
    {
      const Axis a = are_any() ? along : Axis{ { 1., 0., 0. } };
      const Axis b = are_any() ? across : Axis{ { 0., 1., 0. } };
      return {
        { a,
          b,
          { { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] } } }
      };
    }

    template <typename Archive>
    void
    serialize(Archive &archive, unsigned int /*version*/)
    {
      archive &along &across;
    }
  };

  /// An orthotropic elasticity tensor C in its own axes; isotropy with fibres is a special case.
  /// Its numbers are double, or carry derivatives.
  template <typename Number>
  class Orthotropy
  {
  public:
    /// C = 0.
    Orthotropy() : normal{}, shear{} {}

    /// Isotropic, with fibres of this stiffness [Pa] along the first axis.
    Orthotropy(const Isotropic<Number> &material, const Number &fibre_stiffness)
        : shear{ { material.mu, material.mu, material.mu } }
    {
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
          normal[a][b] = material.lambda + (a == b ? Number(2.) * material.mu : Number(0.));
      normal[0][0] += fibre_stiffness;
    }

    /// C_aabb, and C_2323, C_1313 and C_1212 [Pa].
    Orthotropy(const Matrix3<Number> &normal, const std::array<Number, 3> &shear)
        : normal(normal), shear(shear)
    {
    }

    /// The same one, whose numbers have no derivatives.
    template <typename Other>
    explicit Orthotropy(const Orthotropy<Other> &other)
    {
      for (int a = 0; a < 3; ++a)
      {
        shear[a] = Number(other.shear[a]);
        for (int b = 0; b < 3; ++b)
          normal[a][b] = Number(other.normal[a][b]);
      }
    }

    /// The isotropic material nearest to it.
    Isotropic<Number>
    isotropic_part() const
    {
      const Number of_traces = sum_of_entries(normal);
      const Number of_all    = trace(normal) + Number(2.) * (shear[0] + shear[1] + shear[2]);
      const Number mu        = (Number(3.) * of_all - of_traces) / Number(30.);
      return { of_traces / Number(9.) - Number(2. / 3.) * mu, mu };
    }

    /// Half the least eigenvalue of C [Pa].
    Number
    least() const;

    /// The part of C that patches take, lambda_m = 1/(I:C^-1:I) - 2/3 mu_min: C - lambda_m I (x) I
    /// is positive definite [Pa].
    Number
    lambda_of_patches() const
    {
      using std::hypot;
      const Number bulk = Number(1.) / sum_of_entries(compliance());
      // C on deviatoric strains, in an orthonormal basis of those without shear
      const Number          s(std::sqrt(0.5)), t(std::sqrt(1. / 6.));
      const Vector3<Number> basis[2] = { { { s, -s, Number(0.) } }, { { t, t, Number(-2.) * t } } };
      Number                A[2][2];
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j)
          A[i][j] = dot(basis[i], normal * basis[j]);
      const Number mean   = Number(0.5) * (A[0][0] + A[1][1]);
      const Number radius = hypot(Number(0.5) * (A[0][0] - A[1][1]), A[0][1]);
      const Number mu_min
          = std::min({ Number(0.5) * (mean - radius), shear[0], shear[1], shear[2] });
      return bulk - Number(2. / 3.) * mu_min;
    }

    /// About the norm of the anisotropic part of C [Pa]; exactly 0 if isotropic.
    Number
    norm_of_grain() const;

    /// The normal strains of a pressure, scaled to trace 1.
    std::array<Number, 3>
    strain_of_pressure() const
    {
      const Matrix3<Number> inverse = compliance();
      std::array<Number, 3> strain;
      for (int a = 0; a < 3; ++a)
        strain[a] = (inverse[a][0] + inverse[a][1] + inverse[a][2]) / sum_of_entries(inverse);
      return strain;
    }

    /// The normal strains of a tension along the first axis, scaled to 1 along it.
    std::array<Number, 3>
    strain_of_tension() const
    {
      const Matrix3<Number> inverse = compliance();
      return { { Number(1.), inverse[1][0] / inverse[0][0], inverse[2][0] / inverse[0][0] } };
    }

    /// C - lambda I (x) I.
    Orthotropy
    without(const Number &lambda) const
    {
      Orthotropy rest = *this;
      for (auto &row : rest.normal.value)
        for (Number &entry : row)
          entry -= lambda;
      return rest;
    }

    /// a times this plus b times another one in the same axes.
    Orthotropy
    sum(const Number &a, const Number &b, const Orthotropy &other) const
    {
      Orthotropy result;
      result.normal = combine(a, normal, b, other.normal);
      for (int i = 0; i < 3; ++i)
        result.shear[i] = a * shear[i] + b * other.shear[i];
      return result;
    }

    /// The stress C:E of a strain E; both in the axes of the rest pose [Pa].
    Matrix3<Number>
    stress(const GrainAxes &axes, const Matrix3<Number> &E) const
    {
      const Number two(2.);
      return product(normal, { { two * shear[0], two * shear[1], two * shear[2] } }, axes, E);
    }

    /// The strain C^-1:T of a stress T [Pa]; both in the axes of the rest pose.
    Matrix3<Number>
    strain(const GrainAxes &axes, const Matrix3<Number> &T) const
    {
      const Number half(0.5);
      return product(compliance(), { { half / shear[0], half / shear[1], half / shear[2] } }, axes,
                     T);
    }

    /// C in the axes of the rest pose, as Anisotropic has it [Pa].
    std::array<Number, 21>
    entries(const GrainAxes &axes) const;

    template <typename Archive>
    void
    serialize(Archive &archive, unsigned int /*version*/)
    {
      for (auto &row : normal.value)
        for (Number &entry : row)
          archive &entry;
      archive &shear;
    }

  private:
    template <typename Other>
    friend class Orthotropy;

    /// The block of C^-1 for normal strains [1/Pa].
    Matrix3<Number>
    compliance() const
    {
      return inverse_of_symmetric(normal);
    }

    static Number
    sum_of_entries(const Matrix3<Number> &A)
    {
      Number sum(0.);
      for (const auto &row : A.value)
        for (const Number &entry : row)
          sum += entry;
      return sum;
    }

    /// Product with a symmetric matrix of the tensor that has these normal and shear blocks in
    /// these axes.
    static Matrix3<Number>
    product(const Matrix3<Number>       &normal,
            const std::array<Number, 3> &twice_shear,
            const GrainAxes             &axes,
            const Matrix3<Number>       &E)
    {
      const auto      all = axes.complete();
      Matrix3<Number> Q, P; // Q has the axes as rows, P as columns
      for (int a = 0; a < 3; ++a)
        for (int i = 0; i < 3; ++i)
          P[i][a] = Q[a][i] = Number(all[a][i]);
      const Matrix3<Number> of_axes = Q * E * P;
      Matrix3<Number>       T{};
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
        {
          T[a][a] += normal[a][b] * of_axes[b][b];
          if (a != b)
            T[a][b] = twice_shear[3 - a - b] * of_axes[a][b];
        }
      return P * T * Q;
    }

    Matrix3<Number>       normal; ///< C_aabb
    std::array<Number, 3> shear;  ///< C_2323, C_1313, C_1212
  };

  /// The elasticity of E_1, E_2, E_3, nu_23, nu_13, nu_12, G_23, G_13, G_12, where nu_ab is minus
  /// the strain along b over that along a of a tension along a, with fibres of this stiffness [Pa]
  /// along the first axis. Throws UserError, calling the numbers `key`, if C would not be positive
  /// definite.
  Orthotropy<double>
  orthotropy_of(const std::array<double, 9> &constants,
                double                       fibre_stiffness,
                const std::string           &key);

  /// Parse nine numbers. Throws UserError, calling the text `key`, for anything else.
  std::array<double, 9>
  parse_orthotropy(const std::string &text, const std::string &key);
} // namespace Exemplar

#endif
