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
                                                   parts.targets_of_volumes)
  {
    write_hinges();
    for (unsigned int t = 0; t < parts.mesh.triangles().size(); ++t)
      for (unsigned int k = 0; k < 9; ++k)
        arrays.frames[batch_index(t, 9, k)] = parts.mesh.triangles()[t].axes[k / 3][k % 3];
    follow_parameters();
  }

  void
  ShellBody::follow_parameters()
  {
    elasticities.clear();
    for (unsigned int t = 0; t < parts.mesh.triangles().size(); ++t)
      elasticities.push_back(shell_elasticity(parts.material, t, parts.mesh.kind()));
    write_triangles();
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
        greatest = std::max(greatest, scales_at_rest[t][i]);
      for (unsigned int i = 0; i < 3; ++i)
        bending += scales_at_rest[t][3 + i] * greatest;
      const double membrane_stress = stiffness * of_positions * greatest,
                   bending_stress  = stiffness * of_positions * bending;
      squares += triangle.volume()
                 * (membrane_stress * membrane_stress + bending_stress * bending_stress);
      squares_of_strains += triangle.volume() * of_positions * of_positions
                            * (greatest * greatest + bending * bending);
      for (unsigned int i = 0; i < 3; ++i)
      {
        const double gradient = scales_at_rest[t][i];
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
    arrays.past.resize(batched_size(parts.mesh.triangles().size(), n_shell_strains));
    arrays.past.fill(0.);
    for (const WeightedPositions &positions : past)
    {
      const std::vector<ShellStrain> then = strains.strains(*positions.positions);
      for (std::size_t t = 0; t < then.size(); ++t)
        for (unsigned int k = 0; k < n_shell_strains; ++k)
          arrays.past[batch_index(t, n_shell_strains, k)] += positions.weight * then[t][k];
    }
  }

  void
  ShellBody::leave_step()
  {
    damping = 0.;
    arrays.past.clear();
    volumes.leave_step();
  }

  std::vector<double>
  ShellBody::advance_history(const Vector &positions)
  {
    strains.update_branches(positions);
    write_branches();
    return strains.branches();
  }

  void
  ShellBody::set_history(const std::vector<double> &history)
  {
    strains.set_branches(history);
    write_branches();
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
    for (std::size_t t = 0; t < mesh.triangles().size(); ++t)
    {
      const ShellTriangle &triangle = mesh.triangles()[t];
      Matrix3<double>      R{};
      for (int a = 0; a < 3; ++a)
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            R[i][j] += arrays.frames[batch_index(t, 9, 3 * a + i)] * triangle.axes[a][j];
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

  TriangleTask
  ShellBody::triangle_task(const Vector              &positions,
                           const std::vector<double> *weights,
                           const bool                 with_frames)
  {
    return { parts.mesh.kind(),
             parts.mesh.triangles().size(),
             positions.begin(),
             arrays.nodes.data(),
             arrays.hinges.data(),
             arrays.slopes.data(),
             arrays.rest.data(),
             arrays.changes.data(),
             damping,
             damping > 0. ? arrays.past.data() : nullptr,
             parts.targets.arrays(),
             weights == nullptr ? nullptr : weights->data(),
             arrays.strains.data(),
             arrays.targets.data(),
             arrays.areas.data(),
             with_frames ? arrays.frames.data() : nullptr,
             arrays.found.data(),
             arrays.products.data() };
  }

  template <typename Loop>
  void
  ShellBody::for_each_batch(const std::size_t n, const Loop &loop) const
  {
    for_each_part(parts.n_threads, batched_size(n, 1) / batch_size, parts.n_threads,
                  [&](std::size_t /*part*/, const std::size_t begin, const std::size_t end)
                  { loop(begin, end); });
  }

  void
  ShellBody::find_strains(const Vector &positions, const RotationUse rotations)
  {
    volumes.find_changes(positions);
    find_hinges(positions);
    const TriangleTask task = triangle_task(positions, nullptr, rotations != RotationUse::keep);
    for_each_batch(task.n, [&](const std::size_t begin, const std::size_t end)
                   { shell_kernels().find_strains(task, begin, end); });
  }

  void
  ShellBody::find_hinges(const Vector &positions)
  {
    Vector with_fourth_nodes;
    if (strains.has_frames())
      with_fourth_nodes = strains.with_fourth_nodes(positions);
    const Vector   &at = strains.has_frames() ? with_fourth_nodes : positions;
    const HingeTask of_hinges{ at.begin(),
                               arrays.hinge_nodes.data(),
                               arrays.rest_angles.data(),
                               arrays.last_angles.data(),
                               arrays.changes.data(),
                               arrays.forms.data(),
                               arrays.lengths.data() };
    for_each_batch(strains.get_hinges().size(), [&](const std::size_t begin, const std::size_t end)
                   { shell_kernels().find_hinges(of_hinges, begin, end); });
    for (std::size_t h = 0; strains.has_frames() && h < strains.get_hinges().size(); ++h)
      if (strains.get_hinges()[h].frame >= 0)
      {
        HingeForm<double> form;
        for (unsigned int k = 0; k < 12; ++k)
          form[k / 3][k % 3] = arrays.forms[batch_index(h, 12, k)];
        form = strains.pulled_back(h, form);
        for (unsigned int k = 0; k < 12; ++k)
          arrays.forms[batch_index(h, 12, k)] = form[k / 3][k % 3];
        for (unsigned int i = 0; i < 4; ++i)
          arrays.lengths[batch_index(h, 4, i)] = norm(form[i]);
      }
  }

  void
  ShellBody::find_stresses(const Vector &positions, const std::vector<double> &weights)
  {
    const TriangleTask task = triangle_task(positions, &weights, false);
    for_each_batch(task.n,
                   [&](const std::size_t begin, const std::size_t end)
                   {
                     shell_kernels().blend(task, begin, end);
                     shell_kernels().find_forces(task, begin, end);
                   });
    moments.assign(strains.get_hinges().size(), 0.);
    for (unsigned int t = 0; t < task.n; ++t)
      for (unsigned int i = 0; i < 3; ++i)
        if (const ShellTurn &turn = strains.turns(t)[i]; turn.hinge >= 0)
          moments[turn.hinge] += turn.of_hinge * found(t, TriangleResult::moments + i);
  }

  ShellStrain
  ShellBody::numbers_of(const dealii::AlignedVector<double> &of, const unsigned int triangle)
  {
    ShellStrain result;
    for (unsigned int k = 0; k < n_shell_strains; ++k)
      result[k] = of[batch_index(triangle, n_shell_strains, k)];
    return result;
  }

  ShellStrain
  ShellBody::driven_stress(const unsigned int t) const
  {
    const ShellStrain strain = numbers_of(arrays.strains, t),
                      target = numbers_of(arrays.targets, t);
    ShellStrain driven;
    for (unsigned int k = 0; k < n_shell_strains; ++k)
      driven[k] = strain[k] - target[k]
                  + (damping > 0.
                         ? damping * (strain[k] - arrays.past[batch_index(t, n_shell_strains, k)])
                         : 0.);
    return elasticities[t].stress(driven);
  }

  void
  ShellBody::add_energies(ElasticSums &sums) const
  {
    for (unsigned int t = 0; t < parts.mesh.triangles().size(); ++t)
    {
      sums->energy_elastic += found(t, TriangleResult::energy_elastic);
      sums->energy += found(t, TriangleResult::energy);
      sums->energy_damping += found(t, TriangleResult::energy_damping);
      sums->stress_square += found(t, TriangleResult::stress_square);
      sums->min_det_F = min_or_nan(sums->min_det_F, arrays.areas[t]);
    }
  }

  void
  ShellBody::add_forces(ElasticSums &sums)
  {
    moment_scales.assign(moments.size(), 0.);
    for (unsigned int t = 0; t < parts.mesh.triangles().size(); ++t)
    {
      const ShellTriangle &triangle = parts.mesh.triangles()[t];
      const double         scale    = found(t, TriangleResult::scale),
                   of_bending       = found(t, TriangleResult::bending_scale);
      for (unsigned int i = 0; i < 3; ++i)
      {
        const unsigned int node = triangle.nodes[i];
        for (unsigned int c = 0; c < 3; ++c)
          sums->gradient[3 * node + c] += found(t, TriangleResult::forces + 3 * i + c);
        sums->force_scale[node] += scale * scales_at_rest[t][i];
        const ShellTurn &turn         = strains.turns(t)[i];
        const double     moment_scale = of_bending * scales_at_rest[t][3 + i];
        if (turn.hinge >= 0)
          moment_scales[turn.hinge] += turn.of_hinge * moment_scale;
        if (turn.slope < 0)
          continue;
        sums->gradient[turn.slope] += turn.of_slope * found(t, TriangleResult::moments + i);
        sums->force_scale[turn.slope / 3] += std::abs(turn.of_slope) * moment_scale;
      }
    }
    for (std::size_t h = 0; h < moments.size(); ++h)
      for (unsigned int i = 0; i < 4; ++i)
      {
        const unsigned int node = strains.get_hinges()[h].nodes[i];
        for (unsigned int c = 0; c < 3; ++c)
          sums->gradient[3 * node + c] += moments[h] * arrays.forms[batch_index(h, 12, 3 * i + c)];
        sums->force_scale[node] += moment_scales[h] * arrays.lengths[batch_index(h, 4, i)];
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
    find_stresses(positions, weights);
    const bool  with_weights = parts.weights.n_unknown() > 0 && linear_term == nullptr;
    ElasticSums own(std::move(result)); // for its memory
    own->gradient.reinit(positions.size());
    own->force_scale.reinit(parts.mesh.n_nodes());
    own->weight_gradient.assign(parts.weights.n_unknown(), 0.);
    own->weight_scale = own->stress_square = own->energy = own->energy_elastic = 0.;
    own->energy_damping = own->energy_inelastic = 0.;
    own->inverted_cells = own->guarded_cells = 0;
    own->min_det_F                           = std::numeric_limits<double>::max();
    add_energies(own);
    add_forces(own);
    if (with_weights)
      add_weight_products(false, -1., own->weight_gradient);
    volumes.add(positions, weights, with_weights, own);
    result = complete(parts.fe_space.exchange(), std::move(own));
    add_weight_energy(parts.weights, parts.examples.norms(), weights, result);
    if (linear_term != nullptr)
      set_weight_gradient(parts.weights, weights, *linear_term, result);
  }

  void
  ShellBody::add_weight_products(const bool           of_strain_alone,
                                 const double         factor,
                                 std::vector<double> &sums)
  {
    const std::size_t n = parts.targets.arrays().n;
    arrays.products.resize(batched_size(parts.mesh.triangles().size(), n));
    const TriangleTask task = triangle_task({}, nullptr, false);
    for_each_batch(task.n, [&](const std::size_t begin, const std::size_t end)
                   { shell_kernels().find_products(task, of_strain_alone, begin, end); });
    for (unsigned int t = 0; t < task.n; ++t)
      parts.targets.for_each_weight(
          t,
          [&](const unsigned int weight, const unsigned int i, const double share) {
            sums[weight]
                += factor * share * arrays.products[batch_index(t, n, i - task.examples.first)];
          });
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
    add_weight_products(true, 1., c);
    volumes.add_weight_linear_term(c);
    parts.fe_space.exchange().sum(c);
    parts.weights.get_memory().add_linear_term(c);
    return c;
  }

  CellResults
  ShellBody::cell_results(const Vector &positions, const std::vector<double> &weights)
  {
    find_strains(positions, RotationUse::keep);
    find_stresses(positions, weights);
    const double outside = std::sqrt(3.); // the strain of a face by the scaled curvature
    CellResults  results;
    for (unsigned int t = 0; t < parts.mesh.triangles().size(); ++t)
    {
      const ShellStrain strain = numbers_of(arrays.strains, t),
                        target = numbers_of(arrays.targets, t);
      ShellStrain beyond;
      for (unsigned int k = 0; k < n_shell_strains; ++k)
        beyond[k] = strain[k] - target[k];
      const ShellStrain T    = elasticities[t].stress(beyond);
      const auto        face = [&](const double z)
      { return von_mises(T[0] + z * T[3], T[1] + z * T[4], T[2] + z * T[5]); };
      results.strain_energy_density.push_back(0.5
                                              * contract(elasticities[t].stress(strain), strain));
      results.det_F.push_back(arrays.areas[t]);
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
           + dofs.capacity() * sizeof(TriangleDofs) + memory_of_arrays()
           + elasticities.capacity() * sizeof(ShellElasticity);
  }
} // namespace Exemplar
