// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_laws_at_points_h
#define exemplar_laws_at_points_h

#include <exemplar/kernels/cell_model.h>
#include <exemplar/kernels/law_functions.h>
#include <exemplar/kernels/law_slope.h>

#include <array>
#include <utility>

// The functions of LawFunctions for each law, from the members of its cell. What runs in each
// iteration is flat, all of it inlined, as a cell of many matrices would otherwise go through memory
// between its members. As with loops_io.h, only the files that compile them for an instruction set
// include this. No deal.II header here: see matrix3.h.

namespace Exemplar::Laws
{
  template <typename Constants, typename Number>
  inline Constants
  constants_of(const LawInput<Number> &in)
  {
    return Constants::from_numbers([&in](const std::size_t k)
                                   { return Lanes<Number>::load(in.constants + k * batch_size); });
  }

  /// A cell with its deformation and history, on which nothing acts.
  template <typename Cell, typename Number>
  inline Cell
  free_cell(const LawInput<Number> &in)
  {
    Cell cell(constants_of<typename Cell::Constants>(in), in.R, in.F, in.examples);
    if constexpr (Cell::traits.n_history > 0)
      cell.remember([&in](const std::size_t k)
                    { return Lanes<Number>::load(in.history + k * batch_size); },
                    in.step_size);
    return cell;
  }

  template <typename Cell, typename Number>
  inline void
  add_volume_pressure(const LawInput<Number> &in, Cell &cell)
  {
    if constexpr (Cell::traits.has_volumetric_energy)
      cell.add_volume_pressure(in.volume_pressure);
  }

  template <typename Cell, typename Number>
  [[gnu::flatten]] void
  evaluate(const LawInput<Number> &in, const bool with_weight_stress, LawValue<Number> &out)
  {
    constexpr bool remembers = Cell::traits.n_history > 0;

    Cell cell            = free_cell<Cell>(in);
    out.elastic          = cell.elastic_density();
    out.stress_scale     = cell.elastic_scale();
    out.may_be_stretched = cell.may_be_stretched(out.elastic);
    out.is_guarded       = cell.is_guarded();
    out.damping          = Number(0.);
    out.inelastic        = Number(0.);
    if constexpr (remembers)
      out.inelastic = cell.inelastic_density();
    add_volume_pressure(in, cell);
    if (in.has_target)
    {
      out.stress_scale += cell.scale_of(in.target);
      out.energy = cell.energy(in.target);
      if (with_weight_stress)
        out.weight_stress = cell.weight_stress(in.target);
    }
    else if constexpr (remembers) // history variables have inelastic energy, and act like a target
      out.energy = cell.energy();
    else
      out.energy = out.elastic;
    out.force_scale = out.stress_scale;
    if (in.is_damped)
    {
      out.damping = in.damping * cell.damping_density(in.past);
      out.force_scale += in.damping * (cell.elastic_scale() + cell.scale_of(in.past));
      cell.set_target(cell.damp(in.target, in.damping, in.past));
      out.P = cell.force();
    }
    else if (in.has_target)
    {
      cell.set_target(in.target);
      out.P = cell.force();
    }
    else
      out.P = cell.elastic_force();
    out.force_scale *= cell.force_factor();
    if constexpr (Cell::traits.trace_gradient_is_R)
      if (in.has_pressure)
        for (int i = 0; i < 3; ++i)
          out.P[i][i] += in.pressure;
  }

  template <typename Cell, typename Number>
  [[gnu::flatten]] Matrix3<Number>
  weight_stress(const LawInput<Number> &in)
  {
    return free_cell<Cell>(in).weight_stress(Matrix3<Number>{});
  }

  template <typename Cell, typename Number>
  Matrix3<Number>
  stress_of_target(const LawInput<Number> &in)
  {
    Cell cell = free_cell<Cell>(in);
    add_volume_pressure(in, cell);
    return cell.stress_towards(in.target);
  }

  template <typename Cell, typename Number>
  StretchGuard<Number>
  stretch_guard(const LawInput<Number> &in)
  {
    const Cell cell = free_cell<Cell>(in);
    return cell.is_stretched() ? cell.stretch() : StretchGuard<Number>();
  }

  /// The cell with all that acts on it, for the responses of a tangent other than R K R^T.
  template <typename Cell, typename Number>
  inline Cell
  driven_cell(const LawInput<Number> &in, const bool convex)
  {
    Cell cell = free_cell<Cell>(in);
    cell.set_target(in.is_damped ? cell.damp(in.target, in.damping, in.past) : in.target);
    if constexpr (Cell::traits.trace_gradient_is_R)
      cell.add_pressure(in.pressure);
    add_volume_pressure(in, cell);
    if constexpr (!Cell::traits.convex_is_rotated)
      if (convex)
        cell.make_convex();
    return cell;
  }

  template <typename Cell, typename Number>
  void
  tangent(const LawInput<Number> &in, const bool convex, LawTangent<Number> &out)
  {
    if constexpr (!Cell::traits.exact_is_rotated)
      if (!(convex && Cell::traits.convex_is_rotated))
      {
        const Cell cell = driven_cell<Cell>(in, convex);
        return out.set([&](const Matrix3<Number> &M) { return cell.response(M); });
      }
    const auto C = constants_of<typename Cell::Constants>(in).scaled(Number(1.) + in.damping);
    out.set([&](const Matrix3<Number> &M) { return stress(C, symmetric_part(M)); });
  }

  template <typename Cell, typename Number>
  void
  columns(const LawInput<Number> &in,
          const bool              convex,
          const std::size_t       n,
          const Matrix3<Number>  *E,
          Matrix3<Number>        *dP)
  {
    if constexpr (!Cell::traits.exact_is_rotated)
      if (!(convex && Cell::traits.convex_is_rotated))
      {
        const Cell cell = driven_cell<Cell>(in, convex);
        // the damped target changes by 1/(1+s) times the examples' target, see damped_target()
        const Number factor = Number(1.) / (Number(1.) + in.damping);
        for (std::size_t i = 0; i < n; ++i)
          dP[i] = times(factor, cell.example_response(E[i]));
        return;
      }
    const auto C = constants_of<typename Cell::Constants>(in); // Eq. (9)
    for (std::size_t i = 0; i < n; ++i)
      dP[i] = stress(C, E[i]);
  }

  template <typename Cell, typename Number>
  void
  advance(const LawInput<Number> &in, Number *history)
  {
    if constexpr (Cell::traits.n_history > 0)
    {
      const Cell cell = free_cell<Cell>(in);
      for (std::size_t k = 0; k < Cell::traits.n_history; ++k)
        history[k] = cell.new_history(k);
    }
  }

  template <typename Cell, typename Number>
  Matrix3<Number>
  strain(const Matrix3<Number> &R, const Matrix3<Number> &F)
  {
    return Cell::strain_of(R, F);
  }

  /// The slope of a law, or null.
  template <std::size_t law, typename Number>
  constexpr auto
  slope_of()
  {
    using Cell  = std::tuple_element_t<law, CellLaws<Number>>;
    using Along = Dual<OfSlope<Cell>::size, Number>;
    if constexpr (has_potential<Cell>)
      return slope<std::tuple_element_t<law, CellLaws<Along>>, Along, Number>;
    else
      return nullptr;
  }

  template <std::size_t law, typename Number>
  constexpr LawFunctions<Number>
  functions_of()
  {
    using Cell = std::tuple_element_t<law, CellLaws<Number>>;
    return { &Cell::traits,
             Cell::Constants::n_numbers,
             Cell::Constants::is_isotropic,
             evaluate<Cell, Number>,
             weight_stress<Cell, Number>,
             stress_of_target<Cell, Number>,
             stretch_guard<Cell, Number>,
             tangent<Cell, Number>,
             columns<Cell, Number>,
             slope_of<law, Number>(),
             strain<Cell, Number>,
             advance<Cell, Number> };
  }

  template <typename Number, std::size_t... law>
  const LawFunctions<Number> &
  functions_at(const std::size_t i, std::index_sequence<law...> /*all*/)
  {
    static constexpr std::array<LawFunctions<Number>, sizeof...(law)> all
        = { functions_of<law, Number>()... };
    return all[i];
  }
} // namespace Exemplar::Laws

namespace Exemplar
{
  template <typename Number>
  const LawFunctions<Number> &
  law_functions(const CellLaw law)
  {
    return Laws::functions_at<Number>(
        static_cast<std::size_t>(law),
        std::make_index_sequence<std::tuple_size_v<CellLaws<Number>>>());
  }
} // namespace Exemplar

#endif
