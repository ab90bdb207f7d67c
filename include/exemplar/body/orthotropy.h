// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_orthotropy_h
#define exemplar_orthotropy_h

#include <exemplar/kernels/elasticity.h>

#include <array>
#include <string>

namespace Exemplar
{
  /// Orthonormal material axes of a cell at rest: along the fibres, and the second axis of
  /// orthotropy. Zeros where no material needs them.
  struct GrainAxes
  {
    std::array<double, 3> along  = { { 0., 0., 0. } };
    std::array<double, 3> across = { { 0., 0., 0. } };

    template <typename Archive>
    void
    serialize(Archive &archive, unsigned int /*version*/)
    {
      archive &along &across;
    }
  };

  /// An orthotropic elasticity tensor C in its own axes; isotropy with fibres is a special case.
  class Orthotropy
  {
  public:
    /// C = 0.
    Orthotropy() : normal{}, shear{} {}

    /// Isotropic, with fibres of this stiffness [Pa] along the first axis.
    Orthotropy(const CellMaterial<double> &material, double fibre_stiffness);

    /// E_1, E_2, E_3, nu_23, nu_13, nu_12, G_23, G_13, G_12, where nu_ab is minus the strain along
    /// b over that along a of a tension along a. Throws UserError, calling the numbers `key`, if C
    /// would not be positive definite.
    Orthotropy(const std::array<double, 9> &constants,
               double                       fibre_stiffness,
               const std::string           &key);

    /// The isotropic material nearest to it.
    CellMaterial<double>
    isotropic_part() const;

    /// Half the least eigenvalue of C [Pa].
    double
    least() const;

    /// The part of C that patches take, lambda_m = 1/(I:C^-1:I) - 2/3 mu_min: C - lambda_m I (x) I
    /// is positive definite [Pa].
    double
    lambda_of_patches() const;

    /// About the norm of the anisotropic part of C [Pa]; exactly 0 if isotropic.
    double
    norm_of_grain() const;

    /// The normal strains of a pressure, scaled to trace 1.
    std::array<double, 3>
    strain_of_pressure() const;

    /// The normal strains of a tension along the first axis, scaled to 1 along it.
    std::array<double, 3>
    strain_of_tension() const;

    /// C - lambda I (x) I.
    Orthotropy
    without(double lambda) const;

    /// a times this plus b times another one in the same axes.
    Orthotropy
    sum(double a, double b, const Orthotropy &other) const;

    /// The stress C:E of a strain E; both in the axes of the rest pose [Pa].
    Matrix3<double>
    stress(const GrainAxes &axes, const Matrix3<double> &E) const;

    /// The strain C^-1:T of a stress T [Pa]; both in the axes of the rest pose.
    Matrix3<double>
    strain(const GrainAxes &axes, const Matrix3<double> &T) const;

    /// C in the axes of the rest pose, as Anisotropic has it [Pa].
    std::array<double, 21>
    entries(const GrainAxes &axes) const;

    template <typename Archive>
    void
    serialize(Archive &archive, unsigned int /*version*/)
    {
      for (auto &row : normal.value)
        for (double &entry : row)
          archive &entry;
      archive &shear;
    }

  private:
    Matrix3<double>       normal; ///< C_aabb
    std::array<double, 3> shear;  ///< C_2323, C_1313, C_1212
  };

  /// Parse nine numbers. Throws UserError, calling the text `key`, for anything else.
  std::array<double, 9>
  parse_orthotropy(const std::string &text, const std::string &key);
} // namespace Exemplar

#endif
