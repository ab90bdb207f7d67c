// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_point_material_h
#define exemplar_point_material_h

#include <exemplar/body/material.h>
#include <exemplar/body/strain_parts.h>

#include <optional>

// The constants of a cell as functions of Young's modulus, Poisson's ratio and the importance of
// examples, for numbers that carry derivatives. Material has the same for plain numbers.

namespace Exemplar
{
  /// The data of a cell's material that carry no derivatives.
  struct PointMaterial
  {
    PointMaterial(const Material &material,
                  const Material &cell_material,
                  ActsOn          acts_on,
                  double          part_of_patches,
                  unsigned int    cell);

    const Material         &material, &cell_material;
    unsigned int            cell;
    ActsOn                  acts_on;
    Material::BodyConstants body;
    ExampleElasticity       of_examples;
    double                  importance;      ///< importance of the cell, a factor of the global eta
    Vector3<double>         axis;            ///< fibre direction; 0 if no law needs it
    double                  part_of_patches; ///< 1 if patches take the volume part, else 0
  };

  /// Isotropic constants, with fibres if alpha is not 0.
  template <typename Number>
  Fibrous<Number>
  with_fibres(const Number &E, const Number &nu, const Number &alpha, const Vector3<double> &axis)
  {
    const Number mu = E / (Number(2.) * (Number(1.) + nu));
    return { Number(2.) * mu * nu / (Number(1.) - Number(2.) * nu),
             mu,
             alpha,
             { { Number(axis[0]), Number(axis[1]), Number(axis[2]) } } };
  }

  /// a a^T.
  template <typename Number>
  Matrix3<Number>
  dyad(const Vector3<Number> &a)
  {
    Matrix3<Number> A;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        A[i][j] = a[i] * a[j];
    return A;
  }

  /// C^-1:T, by the formula of Sherman and Morrison.
  template <typename Number>
  Matrix3<Number>
  compliance(const Fibrous<Number> &C, const Matrix3<Number> &T)
  {
    const auto isotropic = [&C](const Matrix3<Number> &of)
    {
      const Number half = Number(0.5) / C.mu;
      return combine(half, of,
                     -half * C.lambda * trace(of) / (Number(3.) * C.lambda + Number(2.) * C.mu),
                     identity_matrix<Number>());
    };
    const Matrix3<Number> A = dyad(C.a), E = isotropic(T), of_A = isotropic(A);
    return combine(Number(1.), E,
                   -C.alpha * contract(A, E) / (Number(1.) + C.alpha * contract(A, of_A)), of_A);
  }

  template <typename Number>
  Matrix3<Number>
  constant_matrix(const Matrix3<double> &A)
  {
    Matrix3<Number> result;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        result[i][j] = Number(A[i][j]);
    return result;
  }

  /// The constants of a cell for given E, nu and eta.
  template <typename Number>
  class MaterialFunctions
  {
  public:
    MaterialFunctions(const PointMaterial &of, const Number &E, const Number &nu, const Number &eta)
        : of(of), eta(Number(of.importance) * eta),
          body(with_fibres(E, nu, Number(of.body.fibre_stiffness), of.axis)), examples(body),
          sum(body)
    {
      if (of.of_examples.is_own())
      {
        examples = with_fibres(
            of.of_examples.youngs_modulus ? Number(*of.of_examples.youngs_modulus) : E,
            of.of_examples.poissons_ratio ? Number(*of.of_examples.poissons_ratio) : nu, Number(0.),
            of.axis);
        const Number rest = Number(1.) - this->eta;
        sum.lambda        = rest * body.lambda + this->eta * examples.lambda;
        sum.mu            = rest * body.mu + this->eta * examples.mu;
        sum.alpha         = rest * body.alpha;
      }
    }

    /// eta of the cell.
    const Number &
    importance() const
    {
      return eta;
    }

    /// Whether examples have an elasticity of their own.
    bool
    has_own_examples() const
    {
      return of.of_examples.is_own();
    }

    /// Whether target() is eta times the blend of the examples' strains.
    bool
    has_scaled_target() const
    {
      return of.acts_on == ActsOn::all && !has_own_examples();
    }

    /// The part of C that patches take [Pa].
    Number
    lambda_of_patches() const
    {
      if (of.body.is_orthotropic)
        return Number(of.material.lambda_of_patches(of.cell));
      if (!(sum.alpha > Number(0.)))
        return sum.lambda;
      const Matrix3<Number> I = identity_matrix<Number>();
      return Number(1.) / trace(compliance(sum, I)) - Number(2. / 3.) * sum.mu;
    }

    /// Lame's constants in the guards.
    Isotropic<Number>
    isotropic_part() const
    {
      if (!of.body.is_orthotropic)
        return sum.isotropic_part();
      const CellMaterial<double> &C = of.material.elasticity(of.cell);
      return { Number(C.lambda), Number(C.mu) };
    }

    /// Constants of the cells' own energy, less the part that patches take.
    template <typename Constants>
    Constants
    of_law(const CellLaw law) const
    {
      return Constants::from_numbers(
          [&](const std::size_t k)
          {
            if (law == CellLaw::anisotropic)
              return Number(of.cell_material.number(law, of.cell, k));
            switch (k)
            {
            case 0:
              return without_patches();
            case 1:
              return sum.mu;
            case 2:
              return sum.alpha;
            default:
              return sum.a[static_cast<int>(k) - 3];
            }
          });
    }

    /// D, Eq. (31), from the blend sum w_i E_i of the examples' strains.
    Matrix3<Number>
    target(const Matrix3<Number> &wish) const
    {
      const Matrix3<Number> E = times(eta, acting(wish));
      return of.of_examples.is_own() ? compliance(sum, stress(examples, E)) : E;
    }

    /// D:C_y:D of a target D, less the part that patches take, and lambda of that part; C_y of Eq.
    /// (38), for examples with an elasticity of their own.
    struct Excess
    {
      Number energy, lambda_of_patches;
    };

    Excess
    excess(const Matrix3<Number> &D) const
    {
      if (!(eta > Number(0.)))
        return { Number(0.), Number(0.) };
      Number lambda = Number(0.);
      if (!(body.alpha > Number(0.)))
        lambda = Number(of.part_of_patches) * excess_stress(stretch())[1][1];
      const Number tr = trace(D);
      return { contract(excess_stress(D), D) - lambda * tr * tr, lambda };
    }

  private:
    Number
    without_patches() const
    {
      return sum.lambda - Number(of.part_of_patches) * lambda_of_patches();
    }

    static Matrix3<Number>
    stretch()
    {
      Matrix3<Number> stretch{};
      stretch[0][0] = Number(1.);
      return stretch;
    }

    Matrix3<Number>
    excess_stress(const Matrix3<Number> &D) const
    {
      const Matrix3<Number> E = compliance(examples, stress(body, D));
      return times((Number(1.) - eta) / eta, stress(sum, E));
    }

    /// The part of a strain that examples act on, Eq. (31).
    Matrix3<Number>
    acting(const Matrix3<Number> &E) const
    {
      switch (of.acts_on)
      {
      case ActsOn::shape:
        return combine(Number(1.), E, -trace(E), strain_of_pressure());
      case ActsOn::volume:
        return times(trace(E), strain_of_pressure());
      case ActsOn::along_fibres:
        return along(E);
      case ActsOn::across_fibres:
        return combine(Number(1.), E, Number(-1.), along(E));
      default:
        return E;
      }
    }

    /// Strain under hydrostatic stress, scaled to trace 1.
    Matrix3<Number>
    strain_of_pressure() const
    {
      const Matrix3<Number> third = times(Number(1. / 3.), identity_matrix<Number>());
      if (of.of_examples.is_own())
        return third;
      if (of.body.is_orthotropic)
        return constant_matrix<Number>(part_of_pressure(
            of.material, of.cell,
            combine(1. / 3., identity_matrix<double>(), 0., identity_matrix<double>())));
      const Matrix3<Number> strain = compliance(sum, third);
      return times(Number(1.) / trace(strain), strain);
    }

    Matrix3<Number>
    along(const Matrix3<Number> &E) const
    {
      const Matrix3<Number> A = dyad(sum.a);
      if (!(trace(A) > Number(0.)))
        return Matrix3<Number>{};
      if (of.body.is_orthotropic && !of.of_examples.is_own())
        return times(contract(A, E),
                     constant_matrix<Number>(part_of_tension(of.material, of.cell, dyad(of.axis))));
      const Matrix3<Number> strain = compliance(of.of_examples.is_own() ? examples : sum, A);
      return times(contract(A, E) / contract(A, strain), strain);
    }

    const PointMaterial &of;
    Number               eta;
    Fibrous<Number>      body, examples; ///< C and C_e
    Fibrous<Number>      sum;            ///< C' of Eq. (38), or C
  };
} // namespace Exemplar

#endif
