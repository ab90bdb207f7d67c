// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/shell_body.h>
#include <exemplar/run/adjoint/slope_of_shell.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    ShellStrain
    sum_of(const double a, const ShellStrain &x, const double b, const ShellStrain &y)
    {
      ShellStrain result;
      for (unsigned int k = 0; k < n_shell_strains; ++k)
        result[k] = a * x[k] + b * y[k];
      return result;
    }

    /// The derivative of ShellElasticity::stress() of a strain by Poisson's ratio.
    ShellStrain
    stress_by_poisson(const double E, const double nu, const ShellKind kind, const ShellStrain &a)
    {
      const double square = (1. - nu * nu) * (1. - nu * nu);
      if (kind == ShellKind::hinges)
      {
        const double angle = 2. * nu * E / square;
        return { { 0., 0., 0., angle * a[3], angle * a[4], 0.5 * angle * a[5] } };
      }
      return ShellElasticity{ E * (1. + nu * nu) / square, -0.5 * E / ((1. + nu) * (1. + nu)),
                              kind }
          .stress(a);
    }

    /// eta of number k of a strain in a triangle.
    double
    importance_of(const Problem &problem, const unsigned int t, const unsigned int k)
    {
      return problem.examples.poses.importance() * problem.body.material.importance(t)
             * (k < n_shell_strains / 2 ? 1. : problem.parameters.examples.bending_importance);
    }

    /// A stress whose product with a strain is a part of a slope, the same by Poisson's ratio, and that strain.
    struct SlopePart
    {
      ShellStrain stress, by_poisson, change;
    };

    /// Add what a part of the slope of a triangle gives by the constants of its material and its thickness, to which its curvatures
    /// are proportional, and its volume.
    void
    add_constants(const Problem     &problem,
                  const unsigned int t,
                  const double       volume,
                  const SlopePart   &part,
                  SlopeDerivatives  &sums)
    {
      const double slope   = volume * contract(part.stress, part.change);
      const double bending = volume * contract_bending(part.stress, part.change);
      sums.by_young[t] += slope / problem.body.material.youngs_modulus(t);
      sums.by_poisson[t] += volume * contract(part.by_poisson, part.change);
      sums.add_by_volume(t, slope + 2. * bending);
    }

    /// The elastic slope, triangle by triangle.
    class ElasticSlopeOfShell
    {
    public:
      ElasticSlopeOfShell(const Problem                  &problem,
                          const ShellBody                &body,
                          const Direction                &direction,
                          const std::vector<ShellStrain> &strains,
                          const std::vector<ShellStrain> &changes)
          : problem(problem), body(body), direction(direction), strains(strains), changes(changes),
            of_blend(blended_part(problem.parameters.examples.energy))
      {
      }

      /// Add all but the derivatives by positions; return the stress of these that the changes of weights give.
      ShellStrain
      add(const unsigned int t, SlopeDerivatives &sums) const
      {
        const ExamplePoses    &poses   = problem.examples.poses;
        const TargetBlock     &targets = poses.get_strains();
        const ShellElasticity &C       = body.elasticity(t);
        const double           volume  = problem.body.fe_space.volume(t);
        ShellStrain            D{}, dD{};
        targets.add_blend(t, problem.state.weights, D.data());
        targets.add_blend(t, direction.weights, dD.data());
        const ShellStrain elastic = sum_of(1., strains[t], -1., D),
                          change  = sum_of(1., changes[t], -1., dD);
        add_constants(problem, t, volume, { C.stress(elastic), by_poisson(t, elastic), change },
                      sums);
        if (poses.size() == 0)
          return {};
        add_constants(problem, t, volume,
                      { excess(t, C.stress(D)), excess(t, by_poisson(t, D)), dD }, sums);
        const ShellStrain by_target = sum_of(-1., C.stress(change), 1., excess(t, C.stress(dD))),
                          by_change = sum_of(-1., C.stress(elastic), 1., excess(t, C.stress(D)));
        add_importance(t, contract(by_target, D) + contract(by_change, dD), C.stress(D), dD, sums);
        targets.for_each_weight(
            t,
            [&](const unsigned int weight, const unsigned int i, const double share)
            {
              ShellStrain E;
              for (unsigned int k = 0; k < n_shell_strains; ++k)
                E[k] = targets.number(t, i, k);
              sums.by_weights[weight] += volume * share * contract(by_target, E);
              for (unsigned int k = 0; k < n_shell_strains; ++k)
                sums.by_strains[t * poses.size() + i][k]
                    += volume * share
                       * (problem.state.weights[weight] * by_target[k]
                          + direction.weights[weight] * by_change[k]);
            });
        const ShellStrain of_weights = C.stress(dD);
        return sum_of(-volume, of_weights, 0., of_weights);
      }

    private:
      ShellStrain
      by_poisson(const unsigned int t, const ShellStrain &strain) const
      {
        const Material &material = problem.body.material;
        return stress_by_poisson(material.youngs_modulus(t),
                                 material.of_body_alone(t).poissons_ratio,
                                 problem.body.fe_space.shell().kind(), strain);
      }

      /// The stress of the blended energy beyond that of the others, see ExamplePoses::energy_of_shell().
      ShellStrain
      excess(const unsigned int t, ShellStrain stress) const
      {
        for (unsigned int k = 0; k < n_shell_strains; ++k)
          if (const double eta = importance_of(problem, t, k); eta > 0.)
            stress[k] *= of_blend * (1. - eta) / eta;
          else
            stress[k] = 0.;
        return stress;
      }

      /// Strains of examples are proportional to eta, and the excess has (1 - eta)/eta, of which eta times the derivative is -1/eta.
      void
      add_importance(const unsigned int t,
                     const double       by_size,
                     ShellStrain        stress,
                     const ShellStrain &dD,
                     SlopeDerivatives  &sums) const
      {
        for (unsigned int k = 0; k < n_shell_strains; ++k)
          if (const double eta = importance_of(problem, t, k); eta > 0.)
            stress[k] *= -of_blend / eta;
          else
            stress[k] = 0.;
        sums.by_importance += problem.body.fe_space.volume(t) * (by_size + contract(stress, dD))
                              / problem.examples.poses.importance();
      }

      const Problem                  &problem;
      const ShellBody                &body;
      const Direction                &direction;
      const std::vector<ShellStrain> &strains, &changes;
      const double                    of_blend;
    };

    ShellBody &
    shell_of(const Problem &problem)
    {
      return dynamic_cast<ShellBody &>(*problem.elastic);
    }
  } // namespace

  void
  add_slope_of_shell(Problem &problem, const Direction &direction, SlopeDerivatives &sums)
  {
    ShellBody          &body      = shell_of(problem);
    const ShellStrains &of        = body.get_strains();
    const Vector       &positions = problem.state.positions;
    const auto          strains   = of.strains(positions),
               changes            = of.strain_changes(positions, direction.positions);
    const ElasticSlopeOfShell slope(problem, body, direction, strains, changes);
    std::vector<ShellStrain>  stresses;
    for (unsigned int t = 0; t < strains.size(); ++t)
      stresses.push_back(slope.add(t, sums));
    of.add_pulled_back(positions, stresses, sums.by_positions);
    body.add_exact_response(direction.positions, positions, problem.state.weights,
                            sums.by_positions);
  }

  void
  add_slope_of_shell_damping(Problem           &problem,
                             const State       &start,
                             const Direction   &direction,
                             SlopeDerivatives  &sums,
                             MotionDerivatives &of_motion)
  {
    const ShellBody      &body       = shell_of(problem);
    const ShellStrains   &of         = body.get_strains();
    const Material       &material   = problem.body.material;
    const TimeIntegrator &integrator = *problem.actions.integrator;
    const double rate = integrator.rate_factor(), s = integrator.stiffness_damping_factor();
    const auto   history           = integrator.history(start);
    std::vector<ShellStrain> since = of.strains(problem.state.positions); // the strain since then
    for (const WeightedPositions &past : history)
    {
      const auto then = of.strains(*past.positions);
      for (std::size_t t = 0; t < since.size(); ++t)
        since[t] = sum_of(1., since[t], -past.weight, then[t]);
    }
    const auto changes = of.strain_changes(problem.state.positions, direction.positions);
    std::vector<ShellStrain> by_past;
    of_motion.by_stiffness_damping = 0.;
    for (unsigned int t = 0; t < since.size(); ++t)
    {
      const double      volume     = problem.body.fe_space.volume(t);
      const ShellStrain stress     = body.elasticity(t).stress(since[t]),
                        of_poisson = stress_by_poisson(
                            material.youngs_modulus(t), material.of_body_alone(t).poissons_ratio,
                            problem.body.fe_space.shell().kind(), since[t]),
                        of_changes = body.elasticity(t).stress(changes[t]);
      of_motion.by_stiffness_damping += rate * volume * contract(stress, changes[t]);
      add_constants(problem, t, s * volume, { stress, of_poisson, changes[t] }, sums);
      by_past.push_back(sum_of(-s * volume, of_changes, 0., of_changes));
    }
    of_motion.by_past.clear();
    if (!(s > 0.))
      return;
    for (const WeightedPositions &past : history)
    {
      Vector at(problem.body.fe_space.n_dofs());
      of.add_pulled_back(*past.positions, by_past, at);
      at *= past.weight;
      of_motion.by_past.push_back(std::move(at));
    }
  }

  namespace
  {
    /// The derivatives with respect to the slopes of a pose [1/m], from those with respect to the tips of its normals.
    std::vector<double>
    by_slopes_of(const ShellMesh &mesh, const Vector &pose, const Vector &by_pose)
    {
      std::vector<double> by_slopes;
      for (unsigned int edge = 0; edge < mesh.n_slopes(); ++edge)
      {
        const unsigned int    node  = mesh.slope_node(edge);
        const ShellEdge      &of    = mesh.edges()[edge];
        const Vector3<double> begin = place_in(pose, of.begin), end = place_in(pose, of.end);
        const Vector3<double> along = difference(end, begin),
                              director
                              = difference(place_in(pose, node), combine(0.5, begin, 0.5, end));
        by_slopes.push_back(dot(place_in(by_pose, node), cross(along, director))
                            / (norm(along) * of.length));
      }
      return by_slopes;
    }

    /// What the slopes of a pose give that are found for the material: those of least bending energy.
    void
    add_slopes_of_least_bending(const Problem    &problem,
                                const Vector     &pose,
                                const Vector     &by_pose,
                                SlopeDerivatives &sums)
    {
      const FESpace  &fe_space = problem.body.fe_space;
      const Material &material = problem.body.material;
      const ShellKind kind     = fe_space.shell().kind();
      const auto      elasticity
          = [&](const unsigned int t) { return shell_elasticity(material, t, kind); };
      const auto strains = fe_space.shell_strains(pose);
      const auto adjoint = ShellStrains(fe_space.shell())
                               .adjoint_of_least_bending(
                                   by_slopes_of(fe_space.shell(), pose, by_pose), elasticity);
      for (unsigned int t = 0; t < strains.size(); ++t)
      {
        ShellStrain curvature = strains[t];
        std::fill_n(curvature.begin(), n_shell_strains / 2, 0.);
        const ShellStrain of_poisson = stress_by_poisson(
            material.youngs_modulus(t), material.of_body_alone(t).poissons_ratio, kind, curvature);
        add_constants(problem, t, -fe_space.volume(t),
                      { elasticity(t).stress(curvature), of_poisson, adjoint[t] }, sums);
      }
    }
  } // namespace

  void
  carry_to_shell(const Problem &problem, SlopeDerivatives &sums)
  {
    const ExamplePoses &poses = problem.examples.poses;
    const ShellMesh    &mesh  = problem.body.fe_space.shell();
    ShellStrains        strains(mesh);
    if (mesh.n_slopes() > 0)
      strains.set_held(HeldTips(mesh.edges().size(), held_in_space));
    for (unsigned int i = poses.first_strained(); i < poses.size(); ++i)
    {
      std::vector<ShellStrain> stresses(mesh.triangles().size());
      for (unsigned int t = 0; t < stresses.size(); ++t)
        for (unsigned int k = 0; k < n_shell_strains; ++k)
          stresses[t][k] = importance_of(problem, t, k) * sums.by_strains[t * poses.size() + i][k];
      strains.add_pulled_back(poses.pose(i), stresses, sums.by_poses[i]);
      if (poses.finds_slopes(i))
        add_slopes_of_least_bending(problem, poses.pose(i), sums.by_poses[i], sums);
    }
    for (unsigned int t = 0; t < sums.by_thickness.size(); ++t)
      sums.by_thickness[t] /= mesh.triangles()[t].thickness;
    sums.by_strains.clear();
    sums.by_constants.clear();
    sums.by_gradients.clear();
  }
} // namespace Exemplar
