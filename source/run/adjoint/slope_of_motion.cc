// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/padded_nodes.h>
#include <exemplar/run/adjoint/example_strains.h>
#include <exemplar/run/adjoint/slope_of_motion.h>
#include <exemplar/run/adjoint/slope_of_points.h>
#include <exemplar/run/adjoint/slope_of_shell.h>
#include <exemplar/run/adjoint/slope_terms.h>

#include <deal.II/lac/full_matrix.h>

namespace Exemplar
{
  namespace
  {
    /// Mass matrix of the nodes of a cell with a mass of 1 (scalar).
    dealii::FullMatrix<double>
    unit_matrix(const FESpace &fe_space, const MassMatrix kind)
    {
      if (fe_space.is_shell())
      {
        dealii::FullMatrix<double> of_triangle(3, 3);
        for (unsigned int a = 0; a < 3; ++a)
          for (unsigned int b = 0; b < 3; ++b)
            of_triangle(a, b) = kind == MassMatrix::consistent ? (a == b ? 2. : 1.) / 12.
                                : a == b                       ? 1. / 3.
                                                               : 0.;
        return of_triangle;
      }
      dealii::FullMatrix<double> m = fe_space.unit_mass_matrix();
      if (kind == MassMatrix::consistent)
        return m;
      const NodeShares &shares = traits_of(fe_space.element()).in_cell.by(ShareRule::lumped);
      m                        = 0.;
      for (unsigned int a = 0; a < m.m(); ++a)
        m(a, a) = a < 4 ? shares.of_vertex(1.) : shares.of_edge(1.);
      return m;
    }

    /// sum_ij m_ij a_i.q_j over the nodes of a cell.
    double
    product(const dealii::ArrayView<const unsigned int> &nodes,
            const dealii::FullMatrix<double>            &m,
            const Vector                                &a,
            const Vector                                &q)
    {
      double sum = 0.;
      for (unsigned int i = 0; i < nodes.size(); ++i)
        for (unsigned int j = 0; j < nodes.size(); ++j)
          for (unsigned int c = 0; c < 3; ++c)
            sum += m(i, j) * a[3 * nodes[i] + c] * q[3 * nodes[j] + c];
      return sum;
    }

    void
    add_masses(const Problem    &problem,
               const Direction  &direction,
               const Vector     &q,
               SlopeDerivatives &sums)
    {
      const FESpace &fe_space = problem.body.fe_space;
      const auto     m        = unit_matrix(fe_space, problem.parameters.material.mass_matrix);
      for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
      {
        const double by_density
            = fe_space.cell_volume(cell) * product(fe_space.nodes(cell), m, direction.positions, q);
        sums.by_density[cell] += by_density;
        sums.add_by_volume(cell, problem.body.material.density(cell) * by_density);
      }
    }

    /// The stiffness damping of a slope: the target of a point is the strain at earlier positions.
    class DampingPart
    {
    public:
      template <typename Cell, typename Number>
      using Evaluation = DampingPoint<Cell, Number>;

      static constexpr bool is_damping = true;

      /// Takes the earlier positions of the step; s of Eq. (22) is 1.
      DampingPart(Problem                       &problem,
                  const ExampleStrains          &of_examples,
                  std::vector<WeightedPositions> history)
          : problem(problem), of_examples(of_examples), fe_space(problem.body.fe_space),
            history(std::move(history)), laws(of_examples.get_laws()),
            by_past(this->history.size(), Vector(fe_space.n_dofs())),
            shares_of_patches(problem.body.patches.size(), 1.)
      {
        shares.resize(batched_size(fe_space.n_points(), 1), 1.);
        strains.resize(batched_size(fe_space.n_points(), n_symmetric), 0.);
        for (const WeightedPositions &past : this->history)
          look_back(past);
        if (!shares_of_patches.empty())
          for (unsigned int point = 0; point < fe_space.n_points(); ++point)
            if (shares[point] == 0.)
              shares_of_patches[problem.body.patches.of_point(point)] = 0.;
      }

      void
      set_factor(const double new_s)
      {
        s = new_s;
      }

      static bool
      is_of_law_alone()
      {
        return true;
      }

      /// See ElasticPart.
      bool
      may_be_thin(const unsigned int point) const
      {
        const Matrix3<double> S = combine(1., wish(point).value, 1., identity_matrix<double>());
        return Exemplar::may_be_thin(trace(S), contract(S, S));
      }

      static bool
      has_targets()
      {
        return true;
      }

      static double
      target_factor(const unsigned int /*cell*/)
      {
        return 1.;
      }

      MatrixAlong
      target(const unsigned int point) const
      {
        return wish(point);
      }

      static double
      by_importance(const double /*by_targets_size*/)
      {
        return 0.;
      }

      const LawsOfCells &
      get_laws() const
      {
        return laws;
      }

      double
      share(const unsigned int point) const
      {
        return s * shares[point];
      }

      double
      share_of_patch(const unsigned int patch) const
      {
        return s * shares_of_patches[patch];
      }

      MatrixAlong
      wish(const unsigned int point) const
      {
        return { load_stored(strains.data(), point, 1, 0), {} };
      }

      static PatchScene
      patch_scene(const PointScene & /*scene*/, const ModelTraits & /*law*/)
      {
        return { 0., false, false, false };
      }

      static double
      square_of_bound(const unsigned int /*patch*/, const unsigned int /*point*/)
      {
        return 0.;
      }

      /// Adds derivatives by the earlier positions.
      void
      add_wish(const unsigned int point,
               const MatrixAlong &by_wish,
               const PatchFactors * /*factors*/,
               SlopeDerivatives & /*sums*/,
               Matrix3<double> &by_gradients)
      {
        if (shares[point] == 0.)
          return; // rotations may be ambiguous there; its patch is left out, too
        for (std::size_t m = 0; m < history.size(); ++m)
        {
          const Matrix3<double> F    = fe_space.deformation_gradient(point, *history[m].positions);
          const Matrix3<double> by_F = times(
              history[m].weight, pulled_back(laws[fe_space.cell_of(point)], F, by_wish.value));
          add_forces(fe_space, point, by_F, by_past[m]);
          by_gradients = combine(1., by_gradients, 1., transpose_times(F, by_F));
        }
      }

      void
      add_guard_bound(const double by_bound, SlopeDerivatives &sums) const
      {
        add_slope_of_guard_bound(problem, of_examples, by_bound, sums);
      }

      std::vector<Vector>
      take_by_past()
      {
        return std::move(by_past);
      }

    private:
      /// Skips points that a guard held, and their patches, as StrainDamping does.
      void
      look_back(const WeightedPositions &past)
      {
        CellField                    &field = problem.cells().get_field();
        dealii::AlignedVector<double> places(4 * field.n_nodes());
        pad_nodes(*past.positions, places);
        const CellTask task = field.task_elsewhere(places.data());
        for_each_part(n_parts, task.cells.n_batches(), field.n_threads(),
                      [&](const std::size_t, const std::size_t begin, const std::size_t end)
                      {
                        field.for_each_law(task,
                                           [&](const CellTask &of_law) {
                                             field.loops().add_strains(of_law, past.weight, begin,
                                                                       end, strains.data(),
                                                                       shares.data());
                                           });
                      });
      }

      static constexpr std::size_t n_parts = 16; ///< parts of the loop, whatever the threads

      Problem                             &problem;
      const ExampleStrains                &of_examples;
      const FESpace                       &fe_space;
      const std::vector<WeightedPositions> history;
      const LawsOfCells                   &laws;
      std::vector<Vector>                  by_past;
      double                               s = 1.;
      dealii::AlignedVector<double>        shares;            ///< 1, or 0 where left out
      std::vector<double>                  shares_of_patches; ///< likewise
      dealii::AlignedVector<double>        strains;           ///< sum c_m e(x_m), in batches
    };
  } // namespace

  void
  add_slope_of_inertia(const Problem     &problem,
                       const Direction   &direction,
                       SlopeDerivatives  &sums,
                       MotionDerivatives &of_motion)
  {
    const TimeIntegrator &integrator = *problem.actions.integrator;
    const double          factor     = integrator.mass_factor();
    const Vector          M_a        = problem.actions.mass->times(direction.positions);
    Vector                q          = problem.state.positions;
    q -= integrator.predicted_positions();
    q *= factor;
    add_masses(problem, direction, q, sums);
    sums.by_positions.add(factor, M_a);
    // q = gamma (gamma + a_M) (x - x_star) - gamma v_star, and v = gamma (x - x_star)
    of_motion.by_base = M_a;
    of_motion.by_base *= -factor;
    of_motion.by_base_velocities = M_a;
    of_motion.by_base_velocities *= -integrator.rate_factor();
    of_motion.by_mass_damping = M_a * problem.state.velocities;
  }

  void
  add_slope_of_damping(Problem              &problem,
                       const ExampleStrains &of_examples,
                       const State          &start,
                       const Direction      &direction,
                       SlopeDerivatives     &sums,
                       MotionDerivatives    &of_motion)
  {
    if (problem.body.fe_space.is_shell())
    {
      add_slope_of_shell_damping(problem, start, direction, sums, of_motion);
      return;
    }
    const TimeIntegrator &integrator = *problem.actions.integrator;
    DampingPart           part(problem, of_examples, integrator.history(start));
    part.set_factor(integrator.rate_factor());
    of_motion.by_stiffness_damping
        = SlopeOfPoints<DampingPart>(problem, direction.positions, part).slope();
    const double s = integrator.stiffness_damping_factor();
    if (!(s > 0.))
      return;
    part.set_factor(s);
    SlopeOfPoints<DampingPart>(problem, direction.positions, part).add_to(sums);
    of_motion.by_past = part.take_by_past();
  }
} // namespace Exemplar
