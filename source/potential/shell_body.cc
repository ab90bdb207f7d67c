// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/base/loop_parts.h>
#include <exemplar/body/example_poses.h>
#include <exemplar/kernels/polar_decomposition.h>
#include <exemplar/potential/shell_body.h>
#include <exemplar/potential/weight_energy.h>

#include <deal.II/base/memory_consumption.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Exemplar
{
  namespace
  {
    void
    add_force(const unsigned int node, const double factor, const Vector3<double> &of, Vector &to)
    {
      for (unsigned int c = 0; c < 3; ++c)
        to[3 * node + c] += factor * of[c];
    }

    ShellStrain
    difference(ShellStrain a, const ShellStrain &b)
    {
      for (int k = 0; k < 6; ++k)
        a[k] -= b[k];
      return a;
    }

    double
    norm_of_membrane(const ShellStrain &T)
    {
      return std::sqrt(T[0] * T[0] + T[1] * T[1] + 2. * T[2] * T[2]);
    }

    double
    norm_of_bending(const ShellStrain &T)
    {
      return std::sqrt(T[3] * T[3] + T[4] * T[4] + 2. * T[5] * T[5]);
    }

    double
    norm_in_plane(const std::array<double, 2> &g)
    {
      return std::sqrt(g[0] * g[0] + g[1] * g[1]);
    }

    double
    norm_in_plane(const std::array<double, 3> &A)
    {
      return std::sqrt(A[0] * A[0] + A[1] * A[1] + 2. * A[2] * A[2]);
    }

    /// The equivalent stress of a plane one.
    double
    von_mises(const double x, const double y, const double xy)
    {
      return std::sqrt(x * x + y * y - x * y + 3. * xy * xy);
    }
  } // namespace

  ShellBody::ShellBody(const ShellParts &parts)
      : parts(parts), strains(parts.mesh), volumes(parts.volumes,
                                                   parts.material.volume_stiffness(),
                                                   parts.examples,
                                                   parts.targets_of_volumes),
        triangles(parts.mesh.triangles().size())
  {
    for (const ShellTriangle &triangle : parts.mesh.triangles())
      frames.push_back(triangle.axes);
    follow_parameters();
  }

  void
  ShellBody::follow_parameters()
  {
    elasticities.clear();
    for (unsigned int t = 0; t < parts.mesh.triangles().size(); ++t)
      elasticities.push_back(shell_elasticity(parts.material, t, parts.mesh.kind()));
    volumes.set_stiffness(parts.material.volume_stiffness());
    estimate_rounding();
  }

  void
  ShellBody::estimate_rounding()
  {
    const ShellMesh    &mesh = parts.mesh;
    std::vector<double> forces(mesh.n_nodes(), 0.); // squares
    double              squares = 0., squares_of_strains = 0.;
    rest_size = 0.;
    for (unsigned int i = 0; i < mesh.n_vertices(); ++i)
      for (int c = 0; c < 3; ++c)
        rest_size = std::max(rest_size, std::abs(mesh.vertex(i)[c]));
    const double of_positions = 2. * std::numeric_limits<double>::epsilon() * rest_size;
    for (unsigned int t = 0; t < mesh.triangles().size(); ++t)
    {
      const ShellTriangle &triangle  = mesh.triangles()[t];
      const double         stiffness = 2. * (elasticities[t].lambda + elasticities[t].mu);
      double               greatest  = 0.,
             bending = 0.; // inverse heights, and derivatives of curvatures by positions
      for (unsigned int i = 0; i < 3; ++i)
        greatest = std::max(greatest, norm_in_plane(triangle.gradients[i]));
      for (unsigned int i = 0; i < 3; ++i)
        bending += norm_in_plane(triangle.bending[i]) * greatest;
      const double membrane_stress = stiffness * of_positions * greatest,
                   bending_stress  = stiffness * of_positions * bending;
      squares += triangle.volume()
                 * (membrane_stress * membrane_stress + bending_stress * bending_stress);
      squares_of_strains += triangle.volume() * of_positions * of_positions
                            * (greatest * greatest + bending * bending);
      for (unsigned int i = 0; i < 3; ++i)
      {
        const double gradient = norm_in_plane(triangle.gradients[i]);
        const double force
            = triangle.volume() * std::hypot(membrane_stress * gradient, bending_stress * bending);
        forces[triangle.nodes[i]] += force * force;
      }
    }
    const Exchange &exchange = parts.fe_space.exchange();
    force_of_rounding = std::sqrt(exchange.max(*std::max_element(forces.begin(), forces.end())))
                        + volumes.force_of(of_positions);
    stress_of_rounding = std::sqrt(exchange.sum(squares) + volumes.stress_square_of(of_positions));
    strain_of_rounding = std::sqrt(exchange.sum(squares_of_strains));
  }

  double
  ShellBody::rounding_force(const double size) const
  {
    return (1. + 8. * damping) * force_of_rounding * std::max(1., size / rest_size);
  }

  double
  ShellBody::rounding_weight_gradient() const
  {
    double maximum = 0.;
    for (const double norm : parts.examples.norms())
      maximum = max_or_nan(maximum, stress_of_rounding * norm);
    return maximum;
  }

  void
  ShellBody::begin_step(const double s, const std::vector<WeightedPositions> &past)
  {
    leave_step();
    if (s == 0.)
      return;
    damping = s;
    volumes.begin_step(s, past);
    past_strains.assign(parts.mesh.triangles().size(), ShellStrain{});
    for (const WeightedPositions &positions : past)
    {
      const std::vector<ShellStrain> found = strains.strains(*positions.positions);
      for (std::size_t t = 0; t < found.size(); ++t)
        for (int k = 0; k < 6; ++k)
          past_strains[t][k] += positions.weight * found[t][k];
    }
  }

  void
  ShellBody::leave_step()
  {
    damping = 0.;
    past_strains.clear();
    volumes.leave_step();
  }

  std::vector<double>
  ShellBody::advance_history(const Vector &positions)
  {
    strains.update_branches(positions);
    return {};
  }

  void
  ShellBody::update_rotations(const Vector &positions)
  {
    find_strains(positions, RotationUse::update);
  }

  void
  ShellBody::node_rotations(std::vector<float> &rotations)
  {
    const ShellMesh             &mesh = parts.mesh;
    std::vector<Matrix3<double>> sums(mesh.n_nodes(), Matrix3<double>{});
    for (std::size_t t = 0; t < frames.size(); ++t)
    {
      const ShellTriangle &triangle = mesh.triangles()[t];
      Matrix3<double>      R{};
      for (int a = 0; a < 3; ++a)
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            R[i][j] += frames[t][a][i] * triangle.axes[a][j];
      for (const unsigned int node : triangle.nodes)
        sums[node] = combine(1., sums[node], triangle.area, R);
    }
    rotations.resize(9 * mesh.n_nodes());
    for (unsigned int node = 0; node < mesh.n_nodes(); ++node)
    {
      const Matrix3<double> R
          = node < mesh.n_vertices() ? closest_rotation(sums[node]) : identity_matrix<double>();
      for (int k = 0; k < 9; ++k)
        rotations[9 * node + k] = static_cast<float>(R[k / 3][k % 3]);
    }
  }

  void
  ShellBody::find_strains(const Vector &positions, const RotationUse rotations)
  {
    const unsigned int  n = parts.n_threads;
    std::vector<double> changes(hinges.size());
    volumes.find_changes(positions);
    for_each_part(n, hinges.size(), n,
                  [&](std::size_t /*part*/, const std::size_t begin, const std::size_t end)
                  {
                    for (std::size_t i = begin; i < end; ++i)
                    {
                      const HingeAngle<double> angle = strains.hinge_angle(i, positions);
                      hinges[i].gradient             = angle.gradient();
                      changes[i]                     = strains.change(i, angle);
                    }
                  });
    for_each_part(n, triangles.size(), n,
                  [&](std::size_t /*part*/, const std::size_t begin, const std::size_t end)
                  {
                    for (std::size_t t = begin; t < end; ++t)
                    {
                      TriangleState &state = triangles[t];
                      state.membrane       = strains.membrane(t, positions);
                      state.strain         = strains.strain(t, positions, state.membrane,
                                                            strains.turns_of(t, positions, changes));
                      if (rotations != RotationUse::keep)
                        frames[t] = { { state.membrane.axis(0), state.membrane.axis(1),
                                        state.membrane.normal() } };
                    }
                  });
  }

  void
  ShellBody::find_stresses(const std::vector<double> &weights)
  {
    for (HingeState &hinge : hinges)
      hinge.moment = hinge.moment_scale = 0.;
    for (unsigned int t = 0; t < triangles.size(); ++t)
    {
      TriangleState         &state = triangles[t];
      const ShellElasticity &C     = elasticities[t];
      state.target                 = {};
      parts.targets.add_blend(t, weights, state.target.data());
      state.stress = C.stress(difference(state.strain, state.target));
      state.driven = state.stress;
      if (damping > 0.)
      {
        const ShellStrain of_damping = C.stress(difference(state.strain, past_strains[t]));
        for (int k = 0; k < 6; ++k)
          state.driven[k] += damping * of_damping[k];
      }
      const std::array<double, 3> m = moments(parts.mesh.triangles()[t], state.driven);
      for (int i = 0; i < 3; ++i)
        if (const ShellTurn &turn = strains.turns(t)[i]; turn.hinge >= 0)
          hinges[turn.hinge].moment += turn.of_hinge * m[i];
    }
  }

  std::array<double, 3>
  ShellBody::moments(const ShellTriangle &triangle, const ShellStrain &stress) const
  {
    std::array<double, 3> result;
    for (int i = 0; i < 3; ++i)
    {
      const auto &b = triangle.bending[i];
      result[i] = triangle.volume() * (stress[3] * b[0] + stress[4] * b[1] + 2. * stress[5] * b[2]);
    }
    return result;
  }

  void
  ShellBody::add_energies(const unsigned int t, ElasticSums &sums) const
  {
    const TriangleState   &state   = triangles[t];
    const ShellElasticity &C       = elasticities[t];
    const double           volume  = parts.mesh.triangles()[t].volume();
    const ShellStrain      elastic = C.stress(state.strain), of_target = C.stress(state.target);
    const double           scale
        = std::sqrt(contract(elastic, elastic)) + std::sqrt(contract(of_target, of_target));
    sums->energy_elastic += 0.5 * volume * contract(elastic, state.strain);
    sums->energy += 0.5 * volume * contract(state.stress, difference(state.strain, state.target));
    sums->stress_square += volume * scale * scale;
    sums->min_det_F = min_or_nan(sums->min_det_F, state.membrane.area_ratio());
    if (!(damping > 0.))
      return;
    const ShellStrain change = difference(state.strain, past_strains[t]);
    sums->energy_damping += 0.5 * damping * volume * contract(C.stress(change), change);
  }

  std::array<Vector3<double>, 3>
  ShellBody::membrane_forces(const unsigned int t, const Vector &positions) const
  {
    const ShellTriangle           &triangle = parts.mesh.triangles()[t];
    const ShellStrain             &T        = triangles[t].driven;
    std::array<Vector3<double>, 3> forces{};
    if (parts.mesh.kind() == ShellKind::hinges)
      for (unsigned int i = 0; i < 3; ++i)
      {
        const double force
            = (i == 2 ? 2. : 1.) * T[i] / parts.mesh.edges()[triangle.edges[i]].length;
        const Vector3<double> direction = strains.stretch(t, i, positions).direction;
        forces[i]                       = combine(1., forces[i], -force, direction);
        forces[(i + 1) % 3]             = combine(1., forces[(i + 1) % 3], force, direction);
      }
    else
    {
      const auto P = triangles[t].membrane.force({ { T[0], T[1], T[2] } });
      for (unsigned int i = 0; i < 3; ++i)
        forces[i] = combine(triangle.gradients[i][0], P[0], triangle.gradients[i][1], P[1]);
    }
    return forces;
  }

  void
  ShellBody::add_forces(const unsigned int t, const Vector &positions, ElasticSums &sums)
  {
    const ShellTriangle   &triangle = parts.mesh.triangles()[t];
    const TriangleState   &state    = triangles[t];
    const ShellElasticity &C        = elasticities[t];
    // as the stresses of which the forces are differences
    const auto scale = [&](double (*norm)(const ShellStrain &))
    {
      const double elastic = norm(C.stress(state.strain));
      double       sum     = elastic + norm(C.stress(state.target));
      if (damping > 0.)
        sum += damping * (elastic + norm(C.stress(past_strains[t])));
      return triangle.volume() * sum;
    };
    const ShellStrain &T           = state.driven;
    const auto         membrane    = membrane_forces(t, positions);
    const double       of_membrane = scale(norm_of_membrane), of_bending = scale(norm_of_bending);
    const std::array<double, 3> m = moments(triangle, T);
    for (int i = 0; i < 3; ++i)
    {
      const auto        &g    = triangle.gradients[i];
      const unsigned int node = triangle.nodes[i];
      add_force(node, triangle.volume(), membrane[i], sums->gradient);
      sums->force_scale[node] += of_membrane * norm_in_plane(g);
      const ShellTurn &turn         = strains.turns(t)[i];
      const double     moment_scale = of_bending * norm_in_plane(triangle.bending[i]);
      if (turn.hinge >= 0)
        hinges[turn.hinge].moment_scale += turn.of_hinge * moment_scale;
      if (turn.slope < 0)
        continue;
      sums->gradient[turn.slope] += turn.of_slope * m[i];
      sums->force_scale[turn.slope / 3] += std::abs(turn.of_slope) * moment_scale;
    }
  }

  void
  ShellBody::add_hinge_forces(ElasticSums &sums) const
  {
    for (std::size_t h = 0; h < hinges.size(); ++h)
      for (int i = 0; i < 4; ++i)
      {
        const unsigned int     node     = strains.get_hinges()[h].nodes[i];
        const Vector3<double> &gradient = hinges[h].gradient[i];
        add_force(node, hinges[h].moment, gradient, sums->gradient);
        sums->force_scale[node] += hinges[h].moment_scale * norm(gradient);
      }
  }

  void
  ShellBody::evaluate(const Vector              &positions,
                      const std::vector<double> &weights,
                      ElasticEvaluation         &result,
                      const RotationUse          rotations,
                      const std::vector<double> *linear_term)
  {
    if (linear_term == nullptr) // else they are known from it
      find_strains(positions, rotations);
    find_stresses(weights);
    const bool  with_weights = parts.weights.n_unknown() > 0 && linear_term == nullptr;
    ElasticSums own(std::move(result)); // for its memory
    own->gradient.reinit(positions.size());
    own->force_scale.reinit(parts.mesh.n_nodes());
    own->weight_gradient.assign(parts.weights.n_unknown(), 0.);
    own->weight_scale = own->stress_square = own->energy = own->energy_elastic = 0.;
    own->energy_damping = own->energy_inelastic = 0.;
    own->inverted_cells = own->guarded_cells = 0;
    own->min_det_F                           = std::numeric_limits<double>::max();
    for (unsigned int t = 0; t < triangles.size(); ++t)
    {
      add_energies(t, own);
      add_forces(t, positions, own);
      if (with_weights)
        add_weight_products(t, triangles[t].stress, -1., own->weight_gradient);
    }
    add_hinge_forces(own);
    volumes.add(positions, weights, with_weights, own);
    result = complete(parts.fe_space.exchange(), std::move(own));
    add_weight_energy(parts.weights, parts.examples.norms(), weights, result);
    if (linear_term != nullptr)
      set_weight_gradient(parts.weights, weights, *linear_term, result);
  }

  void
  ShellBody::add_weight_products(const unsigned int   t,
                                 const ShellStrain   &stress,
                                 const double         factor,
                                 std::vector<double> &sums) const
  {
    const double volume = parts.mesh.triangles()[t].volume();
    parts.targets.for_each_weight(
        t, [&](const unsigned int weight, const unsigned int i, const double share)
        { sums[weight] += factor * volume * share * contract(stress, example_strain(t, i)); });
  }

  ShellStrain
  ShellBody::example_strain(const unsigned int t, const unsigned int example) const
  {
    ShellStrain result;
    for (unsigned int k = 0; k < 6; ++k)
      result[k] = parts.targets.number(t, example, k);
    return result;
  }

  std::vector<double>
  ShellBody::weight_linear_term(const Vector &positions, const RotationUse rotations)
  {
    find_strains(positions, rotations);
    std::vector<double> c(parts.examples.n_weights(), 0.);
    for (unsigned int t = 0; t < triangles.size(); ++t)
      add_weight_products(t, elasticities[t].stress(triangles[t].strain), 1., c);
    volumes.add_weight_linear_term(c);
    parts.fe_space.exchange().sum(c);
    parts.weights.get_memory().add_linear_term(c);
    return c;
  }

  CellResults
  ShellBody::cell_results(const Vector &positions, const std::vector<double> &weights)
  {
    find_strains(positions, RotationUse::keep);
    find_stresses(weights);
    const double outside = std::sqrt(3.); // the strain of a face by the scaled curvature
    CellResults  results;
    for (unsigned int t = 0; t < triangles.size(); ++t)
    {
      const TriangleState &state = triangles[t];
      const ShellStrain   &T     = state.stress;
      const auto           face  = [&](const double z)
      { return von_mises(T[0] + z * T[3], T[1] + z * T[4], T[2] + z * T[5]); };
      results.strain_energy_density.push_back(
          0.5 * contract(elasticities[t].stress(state.strain), state.strain));
      results.det_F.push_back(state.membrane.area_ratio());
      if (parts.mesh.kind() == ShellKind::plate)
        results.von_mises_stress.push_back(std::max(face(outside), face(-outside)));
    }
    return results;
  }

  std::size_t
  ShellBody::memory_consumption() const
  {
    using dealii::MemoryConsumption::memory_consumption;
    return strains.memory_consumption() + volumes.memory_consumption()
           + memory_consumption(pattern->column_start) + memory_consumption(pattern->row)
           + dofs.capacity() * sizeof(TriangleDofs) + hinges.capacity() * sizeof(HingeState)
           + triangles.capacity() * sizeof(TriangleState)
           + past_strains.capacity() * sizeof(ShellStrain)
           + elasticities.capacity() * sizeof(ShellElasticity)
           + frames.capacity() * sizeof(frames[0]);
  }
} // namespace Exemplar
