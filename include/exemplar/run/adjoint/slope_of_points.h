// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_slope_of_points_h
#define exemplar_slope_of_points_h

#include <exemplar/base/loop_parts.h>
#include <exemplar/kernels/dual.h>
#include <exemplar/kernels/point_shape.h>
#include <exemplar/run/adjoint/example_strains.h>
#include <exemplar/run/adjoint/point_stress.h>
#include <exemplar/run/adjoint/slope_loops.h>
#include <exemplar/run/adjoint/slope_terms.h>

#include <numeric>

// The derivatives of the slope of a potential that is a sum over points and patches. Each term is
// evaluated with numbers that carry its change along the direction and the derivatives of value and
// change.

namespace Exemplar
{
  /// A matrix of numbers as values with their changes along the direction.
  template <typename Number>
  MatrixAlong
  values_along(const Matrix3<Number> &A)
  {
    return { parts_of<double>(A, [](const Number &number) { return number.value; }),
             parts_of<double>(A, [](const Number &number) { return number.by[0]; }) };
  }

  /// The derivatives of a slope by what belongs to a point, per volume.
  struct PointSlope
  {
    double                                   by_volume = 0.;
    MatrixAlong                              by_shape, by_wish; ///< of the potential
    std::array<double, OfPoint::n_constants> by_constants{};    ///< E, nu, eta and p_0
  };

  /// Call function(point) with the Evaluation, ElasticPoint or DampingPoint, at a place.
  template <template <typename, typename> class Evaluation, typename Number, typename Function>
  void
  with_point(const PointPlace<Number> &at, const Function &function)
  {
    with_potential<Number>(at.law, [&](auto model)
                           { function(Evaluation<typename decltype(model)::type, Number>(at)); });
  }

  /// The stress of an Evaluation, with the terms of its patch, if it has one.
  template <template <typename, typename> class Evaluation, typename Number>
  PointStress<Number>
  stress_at(const PointPlace<Number> &at, const PatchFactors *factors)
  {
    PointStress<Number> found;
    with_point<Evaluation>(at, [&](auto &&point) { found = point.stress(factors); });
    return found;
  }

  /// What part(number) of a stress does along changes of the shape and the wish.
  template <typename Number, typename Part>
  double
  work_along(const PointStress<Number> &stress,
             const Matrix3<double>     &of_shape,
             const Matrix3<double>     &of_wish,
             const Part                &part)
  {
    return contract(parts_of<double>(stress.by_shape, part), of_shape)
           + contract(parts_of<double>(stress.by_wish, part), of_wish);
  }

  /// The derivatives of a slope through an Evaluation whose shape and wish change like this.
  template <template <typename, typename> class Evaluation, typename Number>
  PointSlope
  slope_at(const PointPlace<Number> &at,
           const Matrix3<double>    &of_shape,
           const Matrix3<double>    &of_wish,
           const PatchFactors       *factors)
  {
    const PointStress<Number> found    = stress_at<Evaluation>(at, factors);
    const auto                slope_of = [&](const auto &part)
    { return work_along(found, of_shape, of_wish, part) + part(found.of_patch); };
    PointSlope result{ slope_of([](const Number &number) { return number.value; }),
                       values_along(found.by_shape), values_along(found.by_wish) };
    for (std::size_t k = 1; k < Number::n_derivatives; ++k)
      result.by_constants[k - 1] = slope_of([k](const Number &number) { return number.by[k]; });
    return result;
  }

  /// The point's integrands in the sums of its patch.
  template <template <typename, typename> class Evaluation>
  PatchFactors
  patch_sums(const PointPlace<OfPoint::Changing> &at)
  {
    PatchFactors sums;
    with_point<Evaluation>(at, [&](auto &&point) { sums = point.of_patch(); });
    return sums;
  }

  /// `Part` specifies the potential: Part::Evaluation of point_stress.h, its factors
  /// share(point) and share_of_patch(patch), wish(point), patch_scene(law), and
  /// square_of_bound(patch, point) for the guard (26). add_wish() and add_guard_bound() pass on
  /// derivatives by the wish and by p_0. Where is_of_law_alone(), points have the energy of their
  /// law with the target(point), which is target_factor(cell) times the wish, and no more but for
  /// the dilatation of their patches and its guard; may_be_thin(point) tells whether the trace of
  /// the target may be extended there.
  template <typename Part>
  class SlopeOfPoints
  {
  public:
    /// All arguments must outlive it.
    SlopeOfPoints(Problem &problem, const Vector &along, Part &part)
        : problem(problem), along(along), fe_space(problem.body.fe_space),
          patches(problem.body.patches),
          laws(part.get_laws()), scene{ { problem.body.material, problem.body.cell_material,
                                          problem.parameters.examples.acts_on, patches.size() > 0 },
                                        problem.examples.poses.constants(),
                                        blended_part(problem.parameters.examples.energy) },
          part(part)
    {
      of_patches.resize(patches.size());
      if (part.is_of_law_alone() && patches.size() > 0)
        find_traces();
      for_each_part(n_parts, patches.size(), problem.parameters.solver.n_threads,
                    [this](const std::size_t, const std::size_t begin, const std::size_t end)
                    {
                      for (std::size_t patch = begin; patch < end; ++patch)
                      {
                        if (!traces.empty())
                          select_plain_points(patch);
                        of_patches[patch] = potential_of_patch(patch);
                      }
                    });
    }

    /// The slope itself.
    double
    slope() const
    {
      double sum = 0.;
      Points rest;
      if (part.is_of_law_alone())
        make_loops().for_each_work(drives(),
                                   [&](const unsigned int point, const double work)
                                   {
                                     if (is_plain(point))
                                       sum += part.share(point) * work;
                                     else
                                       rest.push_back(point);
                                   });
      else
        rest = all_points();
      for_each_found<double>(
          rest, [this](const unsigned int point) { return slope_of(point, shape_at(point)); },
          [&](const unsigned int, const double of_point) { sum += of_point; });
      return sum;
    }

    /// Add the slope's derivatives to `sums`.
    void
    add_to(SlopeDerivatives &sums)
    {
      for (const OfPatch &potential : of_patches)
        sums.by_importance += potential.by_importance.by[0];
      const double by_guard_bound
          = add_by_points(part.is_of_law_alone() ? add_by_loops(sums) : all_points(), sums);
      if (by_guard_bound != 0.)
        part.add_guard_bound(by_guard_bound, sums);
    }

  private:
    using Changing = OfPoint::Changing;

    static constexpr std::size_t n_parts = 16; ///< of loops, whatever the threads

    using OfPatch = PatchPotential<Changing>;
    using Points  = std::vector<unsigned int>;

    /// What a patch needs of a point.
    struct TraceAtPoint
    {
      Changing trace;
      double   square;   ///< |F|^2
      bool     is_plain; ///< whether the patch is pressures there, along the traces, and no more
    };

    SlopeLoops
    make_loops() const
    {
      return SlopeLoops(problem.cells().get_field(), problem.state.positions, along,
                        Part::is_damping);
    }

    Points
    all_points() const
    {
      Points all(fe_space.n_points());
      std::iota(all.begin(), all.end(), 0u);
      return all;
    }

    void
    find_traces()
    {
      traces.resize(fe_space.n_points());
      make_loops().for_each_trace(
          [this](const unsigned int point, const auto &found)
          {
            traces[point]
                = { Changing(found(TraceEntry::value), found(TraceEntry::change)),
                    found(TraceEntry::square),
                    !has_guard_at(point)
                        || (found(TraceEntry::may_be_thin) == 0. && !part.may_be_thin(point)) };
          });
    }

    /// Whether the trace is extended in thin cells and strongly stretched patches are guarded.
    bool
    has_guard_at(const unsigned int point) const
    {
      CellLaw law = laws[fe_space.cell_of(point)];
      if (Part::is_damping)
        law = SlopeLoops::damping(law);
      return traits_of(law).has_guard_of_patches();
    }

    ModelTraits
    law_of_patch(const unsigned int patch) const
    {
      return traits_of(laws[fe_space.cell_of(patches.points(patch).front())]);
    }

    /// In patches that may be strongly stretched or are left out no point is plain.
    void
    select_plain_points(const unsigned int patch)
    {
      double square = 0.;
      for (const unsigned int point : patches.points(patch))
        square += fe_space.volume(point) * traces[point].square;
      const bool is_guarded = part.patch_scene(scene, law_of_patch(patch)).has_guard
                              && square > min_stretched_square * patches.volume(patch);
      if (part.share_of_patch(patch) != 0. && !is_guarded)
        return;
      for (const unsigned int point : patches.points(patch))
        traces[point].is_plain = false;
    }

    bool
    is_plain(const unsigned int point) const
    {
      return traces.empty() || traces[point].is_plain;
    }

    /// What drives the loops. What they find where points are not plain counts for nothing.
    auto
    drives() const
    {
      const auto target    = [this](const unsigned int point) { return part.target(point); };
      const auto pressures = [this](const unsigned int point) { return pressures_at(point); };
      return SlopeDrives{ part.has_targets(), target, !traces.empty(), pressures };
    }

    /// Per share of the point's own energy, by which all that a loop finds is multiplied.
    PointPressures
    pressures_at(const unsigned int point) const
    {
      if (!is_plain(point))
        return {};
      const PatchFactors &factors  = *factors_at(point);
      const Changing     &of_trace = factors[PatchSum::trace], &of_wish = factors[PatchSum::wish];
      PointPressures      pressures;
      pressures[PressureEntry::value]            = of_trace.value;
      pressures[PressureEntry::change]           = of_trace.by[0];
      pressures[PressureEntry::of_target]        = of_wish.value;
      pressures[PressureEntry::change_of_target] = of_wish.by[0];
      for (double &pressure : pressures)
        pressure /= part.share(point);
      return pressures;
    }

    /// Returns the derivative by p_0.
    double
    add_by_points(const Points &points, SlopeDerivatives &sums)
    {
      double by_guard_bound = 0.;
      for_each_found<Contribution>(
          points, [this](const unsigned int point) { return contribution(point); },
          [&](const unsigned int point, const Contribution &of_point)
          {
            add(point, of_point, sums);
            by_guard_bound += of_point.by_constants[OfPoint::guard_bound - 1];
          });
      return by_guard_bound;
    }

    /// The same by the loops over the cells. Returns the points that are left: where the guard of
    /// Eq. (16) acts, and where points are not plain.
    Points
    add_by_loops(SlopeDerivatives &sums)
    {
      Points rest;
      make_loops().for_each_slope(drives(),
                                  [&](const unsigned int point, const FoundSlope &found)
                                  {
                                    if (is_plain(point) && found[SlopeEntry::is_guarded] == 0.)
                                      add(point, found, sums);
                                    else
                                      rest.push_back(point);
                                  });
      return rest;
    }

    void
    add(const unsigned int point, const FoundSlope &found, SlopeDerivatives &sums)
    {
      const double       share     = part.share(point);
      const unsigned int cell      = fe_space.cell_of(point);
      Matrix3<double>    by_F      = found.matrix(SlopeEntry::by_F),
                      by_gradients = found.matrix(SlopeEntry::by_gradients);
      if (Part::is_damping)
      {
        by_F         = times(share, by_F);
        by_gradients = times(share, by_gradients);
      }
      add_forces(fe_space, point, by_F, sums.by_positions);
      if (part.has_targets())
      {
        const MatrixAlong by_target{ found.symmetric_matrix(SlopeEntry::by_target),
                                     found.symmetric_matrix(SlopeEntry::by_change_of_target) };
        const double      factor = share * part.target_factor(cell);
        part.add_wish(point, { times(factor, by_target.value), times(factor, by_target.change) },
                      nullptr, sums, by_gradients);
        sums.by_importance += part.by_importance(found[SlopeEntry::by_targets_size]);
      }
      for (std::size_t k = 0; k < LawSlope<double>::n_constants; ++k)
        sums.by_constants[cell][k] += share * found[SlopeEntry::by_constants + k];
      sums.by_importance += share * found[SlopeEntry::by_importance];
      sums.add_by_volume(cell, share * found[SlopeEntry::value]);
      sums.add_by_shape_gradients(cell, by_gradients);
      if (!traces.empty())
        add_patch(point, sums);
    }

    /// What the factors of a point's patch add beside its pressures, through the patch's volume and
    /// elasticity.
    void
    add_patch(const unsigned int point, SlopeDerivatives &sums) const
    {
      const PatchFactors &factors   = *factors_at(point);
      const unsigned int  cell      = fe_space.cell_of(point);
      const double        V         = fe_space.volume(point);
      const double        by_lambda = V * factors[PatchSum::lambda].by[0];
      sums.by_constants[cell][LawSlope<double>::n_constants] += by_lambda;
      sums.add_by_volume(cell, V * factors[PatchSum::volume].by[0]
                                   + by_lambda * problem.body.material.lambda_of_patches(cell));
    }

    /// Evaluate find(point) at these points in parallel, some at a time, and take the results in the
    /// points' order.
    template <typename Found, typename Find, typename Take>
    void
    for_each_found(const Points &points, const Find &find, const Take &take) const
    {
      constexpr unsigned int n_at_once = 1024;
      const unsigned int     n         = points.size();
      std::vector<Found>     found(std::min(n, n_at_once));
      for (unsigned int first = 0; first < n; first += n_at_once)
      {
        const unsigned int n_found = std::min(n_at_once, n - first);
        for_each_part(n_parts, n_found, problem.parameters.solver.n_threads,
                      [&](const std::size_t, const std::size_t begin, const std::size_t end)
                      {
                        for (std::size_t i = begin; i < end; ++i)
                          found[i] = find(points[first + i]);
                      });
        for (unsigned int i = 0; i < n_found; ++i)
          take(points[first + i], found[i]);
      }
    }

    /// The factors of a point's patch; none without patches.
    const PatchFactors *
    factors_at(const unsigned int point) const
    {
      return of_patches.empty() ? nullptr : &of_patches[patches.of_point(point)].by_sums;
    }

    /// Whether the guard of Eq. (16) acts at a point.
    bool
    is_guarded(const unsigned int point, const PointShape &shape) const
    {
      return traits_of(laws[fe_space.cell_of(point)]).has_guard
             && product_of_sums(shape.get().value) < scene.examples.guard_bound;
    }

    PointShape
    shape_at(const unsigned int point) const
    {
      return PointShape(traits_of(laws[fe_space.cell_of(point)]).has_rotations,
                        fe_space.deformation_gradient(point, problem.state.positions),
                        fe_space.deformation_gradient(point, along));
    }

    template <typename Number>
    PointPlace<Number>
    place_of(const unsigned int point, const MatrixAlong &shape, const MatrixAlong &wish) const
    {
      const unsigned int cell = fe_space.cell_of(point);
      return { scene,
               laws[cell],
               cell,
               changing<Number>(shape.value, shape.change),
               changing<Number>(wish.value, wish.change),
               part.share(point) };
    }

    PatchFactors
    sums_at(const unsigned int patch, const unsigned int point) const
    {
      PatchFactors sums = patch_sums<Part::template Evaluation>(
          place_of<Changing>(point, shape_at(point).get(), part.wish(point)));
      sums[PatchSum::bound] = Changing(part.square_of_bound(patch, point));
      return sums;
    }

    /// Without those of guards that do not act.
    PatchFactors
    plain_sums_at(const unsigned int point) const
    {
      Changing wish(0.);
      if (part.has_targets())
      {
        const MatrixAlong D = part.target(point);
        wish                = Changing(trace(D.value), trace(D.change));
      }
      PatchFactors sums = dilatation_sums(
          Changing(problem.body.material.lambda_of_patches(fe_space.cell_of(point))),
          traces[point].trace, wish);
      sums[PatchSum::square] = Changing(traces[point].square);
      return sums;
    }

    PatchFactors
    sums_of(const unsigned int patch) const
    {
      PatchFactors sums;
      for (const unsigned int point : patches.points(patch))
      {
        const PatchFactors of_point = !traces.empty() && traces[point].is_plain
                                          ? plain_sums_at(point)
                                          : sums_at(patch, point);
        const Changing     volume(fe_space.volume(point));
        for (std::size_t k = 0; k < PatchFactors::size; ++k)
          sums.numbers[k] += volume * of_point.numbers[k];
      }
      return sums;
    }

    OfPatch
    potential_of_patch(const unsigned int patch) const
    {
      OfPatch found = patch_potential(part.patch_scene(scene, law_of_patch(patch)), sums_of(patch),
                                      Changing(scene.examples.importance));
      const Changing share(part.share_of_patch(patch));
      for (Changing &factor : found.by_sums.numbers)
        factor *= share;
      return found;
    }

    double
    slope_of(const unsigned int point, const PointShape &shape) const
    {
      using Number            = Dual<0>;
      const MatrixAlong wish  = part.wish(point);
      const auto        found = stress_at<Part::template Evaluation>(
          place_of<Number>(point, shape.get(), wish), factors_at(point));
      return fe_space.volume(point)
             * work_along(found, shape.get().change, wish.change,
                          [](const Number &number) { return number.value; });
    }

    /// A point's part of the slope and its derivatives, to be added at its nodes and its cell.
    struct Contribution
    {
      Matrix3<double>                    by_F, by_gradients;
      MatrixAlong                        by_wish;
      decltype(PointSlope::by_constants) by_constants;
      double                             by_volume; ///< times the volume
    };

    Contribution
    contribution(const unsigned int point) const
    {
      const PointShape shape = shape_at(point);
      return is_guarded(point, shape) ? contribution<OfPoint::Guarded>(point, shape)
                                      : contribution<OfPoint::Regular>(point, shape);
    }

    template <typename Number>
    Contribution
    contribution(const unsigned int point, const PointShape &shape) const
    {
      const PatchFactors *factors = factors_at(point);
      const double        V       = fe_space.volume(point);
      const MatrixAlong   wish    = part.wish(point);
      const PointSlope    found   = slope_at<Part::template Evaluation>(
          place_of<Number>(point, shape.get(), wish), shape.get().change, wish.change, factors);
      const auto [by_F, by_dF] = shape.derivatives(found.by_shape);
      const auto &[F, dF]      = shape.get_gradient();
      Contribution result{ times(V, by_F),
                           combine(V, transpose_times(F, by_F), V, transpose_times(dF, by_dF)),
                           { times(V, found.by_wish.change), times(V, found.by_wish.value) },
                           found.by_constants,
                           V * (found.by_volume + of_guard_bound(point, factors)) };
      for (double &number : result.by_constants)
        number *= V;
      return result;
    }

    /// The point's part of the change of the bound of its patch's guard, through its volume.
    double
    of_guard_bound(const unsigned int point, const PatchFactors *factors) const
    {
      return factors == nullptr ? 0.
                                : (*factors)[PatchSum::bound].by[0]
                                      * part.square_of_bound(patches.of_point(point), point);
    }

    void
    add(const unsigned int point, const Contribution &of_point, SlopeDerivatives &sums)
    {
      const unsigned int cell = fe_space.cell_of(point);
      add_forces(fe_space, point, of_point.by_F, sums.by_positions);
      Matrix3<double> by_gradients = of_point.by_gradients;
      part.add_wish(point, of_point.by_wish, factors_at(point), sums, by_gradients);
      sums.by_young[cell] += of_point.by_constants[OfPoint::E - 1];
      sums.by_poisson[cell] += of_point.by_constants[OfPoint::nu - 1];
      sums.by_importance += of_point.by_constants[OfPoint::eta - 1];
      sums.add_by_volume(cell, of_point.by_volume);
      sums.add_by_shape_gradients(cell, by_gradients);
    }

    Problem                  &problem;
    const Vector             &along;
    const FESpace            &fe_space;
    const Patches            &patches;
    const LawsOfCells        &laws;
    const PointScene          scene;
    Part                     &part;
    std::vector<TraceAtPoint> traces; ///< of each point, if the loops find what is plain in patches
    std::vector<OfPatch>      of_patches; ///< potential of each patch
  };
} // namespace Exemplar

#endif
