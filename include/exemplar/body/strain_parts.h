// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_strain_parts_h
#define exemplar_strain_parts_h

#include <exemplar/body/cell_elasticity.h>
#include <exemplar/body/example_parameters.h>

namespace Exemplar
{
  /// The part of a strain that examples act on, Eq. (31).
  template <typename Number>
  class ActingStrain
  {
  public:
    /// `elasticity` is that of the examples in these axes, which may be none.
    ActingStrain(const ActsOn                  acts_on,
                 const CellElasticity<Number> &elasticity,
                 const GrainAxes              &axes)
        : is_rest(acts_on == ActsOn::shape || acts_on == ActsOn::across_fibres)
    {
      if (acts_on == ActsOn::shape || acts_on == ActsOn::volume)
        part = part_of_pressure(elasticity, axes);
      else if (acts_on != ActsOn::all)
        part = part_of_tension(elasticity, axes);
    }

    Matrix3<Number>
    of(const Matrix3<Number> &E) const
    {
      return part ? projected(E, part->along, part->strain) : E;
    }

    /// The derivative by E of a function with this derivative by the part of E.
    Matrix3<Number>
    by_strain(const Matrix3<Number> &by_part) const
    {
      return part ? projected(by_part, part->strain, part->along) : by_part;
    }

  private:
    /// (along:E) strain of a strain E.
    struct Part
    {
      Matrix3<Number> along, strain;
    };

    Matrix3<Number>
    projected(const Matrix3<Number> &E,
              const Matrix3<Number> &along,
              const Matrix3<Number> &on) const
    {
      const Number factor = contract(along, E);
      return is_rest ? combine(Number(1.), E, -factor, on) : times(factor, on);
    }

    /// What a pressure causes; the rest is isochoric, and the two are orthogonal in energy.
    static Part
    part_of_pressure(const CellElasticity<Number> &elasticity, const GrainAxes &axes)
    {
      const Matrix3<Number> I = identity_matrix<Number>();
      return { I, axes.are_any() ? in_axes(axes, elasticity.tensor().strain_of_pressure())
                                 : times(Number(1. / 3.), I) };
    }

    /// What a tension along the fibres causes; the rest has no stretch along them. 0 without
    /// fibres.
    static Part
    part_of_tension(const CellElasticity<Number> &elasticity, const GrainAxes &axes)
    {
      if (!axes.are_any())
        return {};
      return { in_axes(axes, { { Number(1.), Number(0.), Number(0.) } }),
               in_axes(axes, elasticity.tensor().strain_of_tension()) };
    }

    /// The strain with these normal components in the axes and no shear.
    static Matrix3<Number>
    in_axes(const GrainAxes &axes, const std::array<Number, 3> &entries)
    {
      const auto      all = axes.complete();
      Matrix3<Number> strain{};
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          for (std::size_t a = 0; a < 3; ++a)
            strain[i][j] += entries[a] * Number(all[a][i] * all[a][j]);
      return strain;
    }

    bool                is_rest; ///< whether it is what the part leaves
    std::optional<Part> part;    ///< none where examples act on all
  };
} // namespace Exemplar

#endif
