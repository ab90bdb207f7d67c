// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_law_slope_h
#define exemplar_law_slope_h

#include <exemplar/kernels/dual.h>
#include <exemplar/kernels/law_functions.h>
#include <exemplar/kernels/point_shape.h>

// LawFunctions::slope: a law's stress for registers of numbers that carry derivatives. See
// laws_at_points.h for who may include this. No deal.II header here: see matrix3.h.

namespace Exemplar::Laws
{
  /// The derivatives that numbers carry behind their change along the direction: by the first
  /// constants, and by the importance in laws whose own energy depends on it. An energy density of
  /// lambda and mu alone, all in Pa, is homogeneous in these, from which that by mu follows.
  template <typename Cell>
  struct OfSlope
  {
    static constexpr bool        is_homogeneous = Cell::Constants::n_numbers == 2;
    static constexpr std::size_t n_constants    = is_homogeneous ? 1 : 2;
    static constexpr std::size_t by_constants   = 1;
    static constexpr std::size_t by_importance  = by_constants + n_constants;
    static constexpr std::size_t size
        = by_importance + (Cell::traits.has_volumetric_energy ? 1 : 0);
  };

  template <typename Number>
  inline void
  add_pressure(const Number &pressure, const Number &change, ChangingMatrix<Number> &to)
  {
    for (int i = 0; i < 3; ++i)
    {
      to.value[i][i] += pressure;
      to.change[i][i] += change;
    }
  }

  template <typename Along>
  inline ExampleNumbers<Along>
  examples_along(const ExampleConstants &examples, const std::size_t by_importance)
  {
    ExampleNumbers<Along> result{ Along(examples.guard_bound), Along(examples.importance) };
    if (by_importance < Along::n_derivatives)
      result.importance.by[by_importance] = typename Along::Value(1.);
    return result;
  }

  /// `Cell` is the law for numbers `Along`.
  template <typename Cell, typename Along, typename Number>
  [[gnu::flatten]] void
  slope(const LawInput<Number> &in, const LawChange<Number> &change, LawSlope<Number> &out)
  {
    using Of = OfSlope<Cell>;
    const ShapeAtPoint<Number> shape(Cell::traits.has_rotations, in.R, in.F, change.F);
    const auto                 constants = Cell::Constants::from_numbers(
        [&in](const std::size_t k)
        {
          Along number;
          number.value = Lanes<Number>::load(in.constants + k * batch_size);
          if (k < Of::n_constants)
            number.by[Of::by_constants + k] = Number(1.);
          return number;
        });
    const Matrix3<Along> D = changing<Along>(in.target, change.target);
    Cell                 cell(constants, identity_matrix<Along>(),
                              changing<Along>(shape.get().value, shape.get().change),
                              examples_along<Along>(in.examples, Of::by_importance));
    out.is_guarded = cell.is_guarded();
    cell.set_target(D);
    Matrix3<Along> T = cell.force(), Q{};
    if (cell.is_stretched())
      T = combine(Along(1.), T, Along(1.), cell.stretch().force());
    if (in.has_target)
      Q = times(-1., cell.weight_stress(D));
    const auto slope_of = [&](const auto &part)
    {
      const Number of_shape = contract(parts_of<Number>(T, part), shape.get().change);
      return in.has_target ? of_shape + contract(parts_of<Number>(Q, part), change.target)
                           : of_shape;
    };
    const auto value   = [](const Along &number) { return number.value; };
    const auto changed = [](const Along &number) { return number.by[0]; };
    out.value          = slope_of(value);
    for (std::size_t k = 0; k < Of::n_constants; ++k)
      out.by_constants[k]
          = slope_of([k](const Along &number) { return number.by[Of::by_constants + k]; });
    if constexpr (Of::is_homogeneous)
      out.by_constants[1] = (out.value - constants.number(0).value * out.by_constants[0])
                            / constants.number(1).value;
    out.by_importance = Number(0.);
    if constexpr (Of::by_importance < Along::n_derivatives)
      out.by_importance
          = slope_of([](const Along &number) { return number.by[Of::by_importance]; });
    ChangingMatrix<Number> of_shape{ parts_of<Number>(T, value), parts_of<Number>(T, changed) },
        of_target{ parts_of<Number>(Q, value), parts_of<Number>(Q, changed) };
    if constexpr (Cell::traits.trace_gradient_is_R)
      if (in.has_pressure)
      {
        out.value += in.pressure * trace(shape.get().change)
                     + change.pressure * trace(cell.strain()).value
                     + change.of_target * trace(change.target)
                     + change.change_of_target * trace(in.target);
        add_pressure(in.pressure, change.pressure, of_shape);
        add_pressure(change.of_target, change.change_of_target, of_target);
      }
    const auto of_F         = shape.derivatives(of_shape);
    out.by_F                = of_F.by_F;
    out.by_change_of_F      = of_F.by_dF;
    out.by_target           = of_target.change;
    out.by_change_of_target = of_target.value;
  }
} // namespace Exemplar::Laws

#endif
