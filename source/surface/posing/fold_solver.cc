// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/surface/posing/fold_neighbourhood.h>
#include <exemplar/surface/posing/fold_solver.h>

#include <deal.II/lac/solver_cg.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Exemplar
{
  namespace
  {
    /// Relative tolerance and greatest number of iterations of conjugate gradients; a direction for
    /// a line search needs no better.
    constexpr double       cg_tolerance   = 1e-2;
    constexpr unsigned int max_iterations = 30;

    /// A symmetric matrix, given by its lower triangle, plus the Hessian of the skin's springs.
    struct MatrixWithSprings
    {
      const SymmetricPattern    &pattern;
      const std::vector<double> &values;
      const SkinSprings         &springs;

      void
      vmult(Vector &product, const Vector &vector) const
      {
        product = 0.;
        for (unsigned int j = 0; j < pattern.n(); ++j)
        {
          int p = pattern.column_start[j];
          product[j] += values[p] * vector[j];
          for (++p; p < pattern.column_start[j + 1]; ++p)
          {
            product[pattern.row[p]] += values[p] * vector[j];
            product[j] += values[p] * vector[pattern.row[p]];
          }
        }
        springs.add_product(vector, product);
      }
    };

    struct Inverse
    {
      SpdOperator &system;

      void
      vmult(Vector &product, const Vector &vector) const
      {
        std::vector<double> column(vector.begin(), vector.end());
        system.solve(column);
        std::copy(column.begin(), column.end(), product.begin());
      }
    };

    using Points = FoldPotential::Points;

    constexpr unsigned int n_rotation_steps = 10;
    constexpr unsigned int max_settling     = 40;
    constexpr unsigned int max_attempts     = 20;

    /// Relative decrease of the energy in a step at which Newton's method has converged.
    constexpr double settled = 1e-5;

    /// Relative decrease of the energy at which to stop on the way to stronger springs.
    constexpr double nearly_settled = 1e-4;

    /// Factor by which springs of the skin are made stronger, and how often.
    constexpr double       strengthening  = 4.;
    constexpr unsigned int n_strengthened = 5;

    /// Springs act at vertices around which det F is greater than least_drawn, and become stronger
    /// where it is greater than least_strengthened. least_drawn also bounds how far the least det F
    /// of a pose may fall.
    constexpr double least_drawn = 0.05, least_strengthened = 0.2;

    /// The springs are strengthened again if the mean error of the vertices falls to this share at
    /// least.
    constexpr double worthwhile = 0.99;

    /// If the mean error falls to much_nearer, det F below least_drawn may fall to hardly_less of
    /// what it was, and the greatest error of a vertex may rise to hardly_more times that at the
    /// start. If it falls by less, det F below least_drawn must not fall, and the greatest error
    /// may rise to hardly_more times the last one, but not beyond that at the start.
    constexpr double much_nearer = 0.95, hardly_less = 0.9, hardly_more = 1.05;

    /// Least relative decrease of the energy that is assumed when eps is reduced. Garanzha et al.
    /// take .1; four times as much is faster and mostly suffices, where a step changes the energy
    /// by no more than a share `calm`.
    constexpr double hasty = 0.4, patient = 0.1, calm = 4e-4;

    /// Least eps: cells that are inverted at it stay so.
    constexpr double min_eps = 5e-3;

    /// Eps at the beginning, and eps below which few inverted cells are left to be treated alone.
    constexpr double far_eps = 1., near_eps = 0.1;

    /// Inverted cells are treated alone if at most one node in so many is theirs.
    constexpr std::size_t few = 200;

    constexpr unsigned int first_rings = 4; ///< rings of cells around inverted ones

    double
    minimum(const std::vector<double> &values)
    {
      return *std::min_element(values.begin(), values.end());
    }

    Points
    moved(Points x, const std::vector<double> &direction, const double factor)
    {
      for (std::size_t i = 0; i < x.size(); ++i)
        for (int d = 0; d < 3; ++d)
          x[i][d] += factor * direction[3 * i + d];
      return x;
    }

    /// The nodes of inverted cells, or nearly inverted ones.
    std::vector<char>
    nodes_of_inverted(const FoldPotential &potential, const Points &x)
    {
      const std::vector<double> determinants = potential.determinants(x);
      std::vector<char>         nodes(x.size(), 0);
      for (std::size_t c = 0; c < determinants.size(); ++c)
        if (determinants[c] <= 2. * FoldSolver::margin)
          for (const unsigned int i : potential.get_cells()[c])
            nodes[i] = 1;
      return nodes;
    }

    /// The least det F of the cells around the nodes that carry each vertex of the skin.
    std::vector<double>
    determinants_at_skin(const FoldPotential &potential, const Points &x)
    {
      constexpr double          relevant     = 0.1; // smaller ones are of recovered derivatives
      const std::vector<double> determinants = potential.determinants(x);
      std::vector<double>       of_node(x.size(), std::numeric_limits<double>::infinity());
      for (std::size_t c = 0; c < determinants.size(); ++c)
        for (const unsigned int i : potential.get_cells()[c])
          of_node[i] = std::min(of_node[i], determinants[c]);
      const SkinSprings  &skin = potential.skin;
      std::vector<double> result(skin.stiffness.size(), std::numeric_limits<double>::infinity());
      for (std::size_t v = 0; v < result.size(); ++v)
        for (const auto &[node, share] : skin.shares_of(v))
          if (std::abs(share) > relevant)
            result[v] = std::min(result[v], of_node[node]);
      return result;
    }

    std::size_t
    count(const std::vector<char> &marked)
    {
      return static_cast<std::size_t>(std::count(marked.begin(), marked.end(), 1));
    }
  } // namespace

  FoldSystem::FoldSystem(const FoldPotential &potential)
      : potential(potential), system(make_cholesky_operator(potential.get_n_threads())),
        pattern(potential.block_pattern())
  {
    system->reinit(pattern);
  }

  void
  FoldSystem::factorize(const FoldPotential::Points &x, const double eps)
  {
    potential.assemble(x, eps, system->values());
    if (!potential.skin.empty())
    {
      without_skin                    = system->values();
      const std::vector<double> bound = potential.skin.diagonal_bound(x.size());
      for (unsigned int k = 0; k < pattern.n(); ++k)
        system->values()[pattern.column_start[k]] += bound[k / 3];
    }
    factorize_shifted();
  }

  /// Factorizes the matrix, with growing shifts of its diagonal if need be: it is positive, but
  /// nearly collapsed cells may be so stiff that rounding makes pivots negative.
  void
  FoldSystem::factorize_shifted()
  {
    const std::vector<double> values = system->values();
    for (double shift = 1e-14; shift < 1.; shift *= 100.)
      try
      {
        system->factorize({});
        return;
      }
      catch (const SolverFailure &)
      {
        for (unsigned int k = 0; k < pattern.n(); ++k)
          system->values()[pattern.column_start[k]]
              = (1. + shift) * values[pattern.column_start[k]];
      }
    throw indefinite_matrix();
  }

  std::vector<double>
  FoldSystem::solve(const std::vector<double> &right_side) const
  {
    std::vector<double> solution = right_side;
    if (potential.skin.empty())
    {
      system->solve(solution);
      return solution;
    }
    Vector                         b(right_side.begin(), right_side.end()), x(right_side.size());
    dealii::IterationNumberControl control(max_iterations, cg_tolerance * b.l2_norm());
    dealii::SolverCG<Vector>       cg(control);
    cg.solve(MatrixWithSprings{ pattern, without_skin, potential.skin }, x, b, Inverse{ *system });
    std::copy(x.begin(), x.end(), solution.begin());
    return solution;
  }

  FoldSolver::FoldSolver(FoldPotential &potential) : potential(potential), system(potential) {}

  /// The as-rigid-as-possible deformation (Sorkine and Alexa 2007) of the tetrahedra, from the
  /// harmonic one.
  Points
  FoldSolver::nearest_rotations() const
  {
    const auto laplacian = make_cholesky_operator(potential.get_n_threads());
    laplacian->reinit(potential.node_pattern());
    potential.assemble_rotations(laplacian->values());
    laplacian->factorize({});
    const std::size_t n = potential.node_pattern().n();
    Points            x(n);
    for (unsigned int k = 0; k < n_rotation_steps; ++k)
    {
      std::vector<double> columns = potential.rotated_rest(k == 0 ? nullptr : &x);
      laplacian->solve(columns);
      for (std::size_t i = 0; i < n; ++i)
        for (int d = 0; d < 3; ++d)
          x[i][d] = columns[d * n + i];
    }
    return x;
  }

  /// A damped Newton step, halved until the energy falls as it should (Armijo). Returns the
  /// decrease of the energy over the energy + 5, which is positive.
  double
  FoldSolver::step(Result &result, const double eps)
  {
    system.factorize(result.x, eps);
    const std::vector<double> gradient  = potential.gradient(result.x, eps);
    const std::vector<double> direction = system.solve(gradient);
    double                    slope     = 0.;
    for (std::size_t k = 0; k < gradient.size(); ++k)
      slope -= gradient[k] * direction[k];
    const double before = potential.value(result.x, eps);
    ++result.iterations;
    if (tell)
      tell(result.iterations);
    for (double length = 1.; length > 1e-10; length *= 0.5)
    {
      Points       x     = moved(result.x, direction, -length);
      const double after = potential.value(x, eps);
      if (after <= before + 1e-4 * length * slope)
      {
        result.x       = std::move(x);
        result.min_det = minimum(potential.determinants(result.x));
        return (before - after) / (before + 5.);
      }
    }
    return 0.;
  }

  /// Takes Newton steps with eps reduced as Garanzha et al. (2021) do it, Eq. (6), until no cell is
  /// inverted, eps is at its least, or few nodes are left in inverted cells.
  void
  FoldSolver::untangle(Result &result, double eps, const double min_share, const std::size_t n_left)
  {
    while (eps > min_eps && result.min_det <= margin)
    {
      if (eps < near_eps && count(nodes_of_inverted(potential, result.x)) <= n_left)
        return;
      const double gone = std::max(0., step(result, eps));
      const double share
          = std::max({ gone, patient, std::min(min_share, min_share * calm / gone) });
      const double det = result.min_det, root = std::hypot(det, eps);
      eps *= det >= 0. ? 1. - share : 1. - share * root / (std::abs(det) + root);
    }
  }

  void
  FoldSolver::settle(Result &result, const double share)
  {
    for (unsigned int k = 0; k < max_settling && step(result, 0.) > share; ++k)
    {
    }
  }

  /// Halves the stiffness of the springs at the nodes of inverted cells and of their neighbours.
  void
  FoldSolver::release(Result &result)
  {
    const std::vector<char> around
        = grown(potential.get_cells(), nodes_of_inverted(potential, result.x), 1);
    ++result.releases;
    for (std::size_t i = 0; i < around.size(); ++i)
      if (around[i] != 0)
        potential.attachment.stiffness[i] *= 0.5;
  }

  /// Repeats the search around inverted cells alone, by smaller reductions of eps, which would be
  /// too slow for the whole body, with more and more of the body free to move and softer and softer
  /// springs.
  void
  FoldSolver::untangle_neighbourhoods(Result &result, const Points &rest)
  {
    for (unsigned int attempt = 0; attempt < max_attempts && result.min_det <= margin; ++attempt)
    {
      if (attempt > 0)
        release(result);
      FoldNeighbourhood neighbourhood(
          potential, rest, result.x, nodes_of_inverted(potential, result.x), first_rings + attempt);
      FoldSolver solver(neighbourhood.get_potential());
      Result     local{ neighbourhood.get_start() };
      local.min_det = minimum(neighbourhood.get_potential().determinants(local.x));
      solver.untangle(local, far_eps, patient, 0);
      neighbourhood.copy_back(local.x, result.x);
      result.min_det = minimum(potential.determinants(result.x));
      result.iterations += local.iterations;
    }
  }

  void
  FoldSolver::draw_nearer(Result &result, const std::vector<double> &stiffness)
  {
    SkinSprings            &skin   = potential.skin;
    const SkinSprings::Ways start  = skin.ways(result.x);
    SkinSprings::Ways       before = start;
    for (unsigned int time = 0; time <= n_strengthened; ++time)
    {
      const std::vector<double> det = determinants_at_skin(potential, result.x);
      for (std::size_t v = 0; v < stiffness.size(); ++v)
        if (det[v] > (time == 0 ? least_drawn : least_strengthened))
          skin.stiffness[v] = time == 0 ? stiffness[v]
                                        : strengthening * std::max(stiffness[v], skin.stiffness[v]);
      Result next = result;
      settle(next, nearly_settled);
      const SkinSprings::Ways ways = skin.ways(next.x);

      const bool   much      = ways.mean <= much_nearer * before.mean;
      const double least_det = (much ? hardly_less : 1.) * result.min_det;
      const double most      = much ? hardly_more * start.greatest
                                    : std::min(hardly_more * before.greatest, start.greatest);
      if (ways.mean > worthwhile * before.mean || ways.greatest > most
          || next.min_det < std::min(least_det, least_drawn))
        return;
      result = std::move(next);
      before = ways;
    }
  }

  FoldSolver::Result
  FoldSolver::solve(const Points &rest)
  {
    const Attachment given = potential.attachment;
    Result           result{ nearest_rotations() };
    result.min_det = minimum(potential.determinants(result.x));
    untangle(result, far_eps, hasty, rest.size() / few);
    for (unsigned int attempt = 0; attempt < 3; ++attempt)
    {
      untangle_neighbourhoods(result, rest);
      if (result.min_det <= margin)
        break;
      settle(result, settled);
      if (result.min_det > margin)
        return result;
    }
    potential.attachment = given;
    result.x             = rest;
    for (unsigned int k = 0; k < 5; ++k)
      settle(result, settled);
    return result;
  }
} // namespace Exemplar
