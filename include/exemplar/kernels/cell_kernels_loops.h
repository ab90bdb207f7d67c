// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_cell_kernels_loops_h
#define exemplar_cell_kernels_loops_h

#include <exemplar/kernels/cell_kernels.h>

#include <type_traits>

// The loops of cell_kernels.h for a number type. Only the files that compile them for an
// instruction set include this; nothing here may be instantiated for other types there,
// or the linker might take that code for CPUs that cannot run it.

namespace Exemplar
{
  template <typename Number>
  struct CellLoops
  {
    static constexpr std::size_t width = Lanes<Number>::n;

    /// Cells of a batch that are computed at once.
    struct LaneGroup
    {
      std::size_t batch;
      std::size_t lane; ///< the first

      /// Where entry e of n of a quantity begins.
      std::size_t
      at(const std::size_t n, const std::size_t e) const
      {
        return (batch * n + e) * batch_size + lane;
      }
    };

    static Number
    load(const double *from, const LaneGroup &group, const std::size_t n, const std::size_t e)
    {
      return Lanes<Number>::load(from + group.at(n, e));
    }

    static CellMaterial<Number>
    load_lame(const CellArrays &cells, const LaneGroup &group)
    {
      return { load(cells.lame, group, 2, 0), load(cells.lame, group, 2, 1) };
    }

    static Matrix3<Number>
    load_rotation(const CellArrays &cells, const LaneGroup &group)
    {
      Matrix3<Number> R;
      for (int k = 0; k < 9; ++k)
        R[k / 3][k % 3] = load(cells.rotations, group, 9, k);
      return R;
    }

    /// A symmetric matrix that is entry `i` of n.
    static Matrix3<Number>
    load_strain(const double     *strains,
                const LaneGroup  &group,
                const std::size_t n,
                const std::size_t i)
    {
      Number E[6];
      for (int k = 0; k < 6; ++k)
        E[k] = load(strains, group, 6 * n, 6 * i + k);
      return { { { E[0], E[5], E[4] }, { E[5], E[1], E[3] }, { E[4], E[3], E[2] } } };
    }

    static Tetrahedron<Number>
    load_tetrahedron(const CellArrays &cells, const LaneGroup &group)
    {
      Tetrahedron<Number> tet;
      for (int i = 0; i < 3; ++i)
      {
        for (int a = 1; a < 4; ++a)
          tet.shape_gradient[a][i] = load(cells.gradients, group, 9, 3 * (a - 1) + i);
        tet.shape_gradient[0][i] = -tet.shape_gradient[1][i] - tet.shape_gradient[2][i]
                                   - tet.shape_gradient[3][i]; // shape functions sum to one
      }
      tet.volume = load(cells.volumes, group, 1, 0);
      return tet;
    }

    /// Four numbers of one cell; the compiler maps them to what registers there are.
    using Four = double [[gnu::vector_size(32)]];
    using Mask = long [[gnu::vector_size(32)]];

    [[gnu::always_inline]] static inline Four
    load_four(const double *from)
    {
      Four four;
      __builtin_memcpy(&four, from, sizeof(Four));
      return four;
    }

    [[gnu::always_inline]] static inline void
    store_four(const Four &four, double *to)
    {
      __builtin_memcpy(to, &four, sizeof(Four));
    }

    [[gnu::always_inline]] static inline void
    transpose(Four (&rows)[4])
    {
      const Four low_01  = __builtin_shuffle(rows[0], rows[1], Mask{ 0, 4, 2, 6 });
      const Four high_01 = __builtin_shuffle(rows[0], rows[1], Mask{ 1, 5, 3, 7 });
      const Four low_23  = __builtin_shuffle(rows[2], rows[3], Mask{ 0, 4, 2, 6 });
      const Four high_23 = __builtin_shuffle(rows[2], rows[3], Mask{ 1, 5, 3, 7 });

      rows[0] = __builtin_shuffle(low_01, low_23, Mask{ 0, 1, 4, 5 });
      rows[1] = __builtin_shuffle(high_01, high_23, Mask{ 0, 1, 4, 5 });
      rows[2] = __builtin_shuffle(low_01, low_23, Mask{ 2, 3, 6, 7 });
      rows[3] = __builtin_shuffle(high_01, high_23, Mask{ 2, 3, 6, 7 });
    }

    /// The numbers of as many cells as a register holds; by way of memory the processor would
    /// wait for the narrower stores.
    static Number
    join(const Four (&four)[2])
    {
      if constexpr (width == 8)
        return Number(__builtin_shufflevector(four[0], four[1], 0, 1, 2, 3, 4, 5, 6, 7));
      else
        return Number(four[0]);
    }

    /// Positions of one node of each cell.
    static void
    load_nodes(const double *positions, const int *nodes, Vector3<Number> &x)
    {
      if constexpr (width >= 4)
      {
        Four parts[3][2];
        for (std::size_t lane = 0; lane < width; lane += 4)
        {
          Four rows[4];
          for (std::size_t l = 0; l < 4; ++l)
            rows[l] = load_four(positions + 4 * nodes[lane + l]);
          transpose(rows);
          for (int i = 0; i < 3; ++i)
            parts[i][lane / 4] = rows[i];
        }
        for (int i = 0; i < 3; ++i)
          x[i] = join(parts[i]);
      }
      else
      {
        alignas(64) double parts[3][width];
        for (std::size_t lane = 0; lane < width; ++lane)
          for (int i = 0; i < 3; ++i)
            parts[i][lane] = positions[4 * nodes[lane] + i];
        for (int i = 0; i < 3; ++i)
          x[i] = Lanes<Number>::load(parts[i]);
      }
    }

    static Matrix3<Number>
    deformation_gradient(const CellTask            &task,
                         const LaneGroup           &group,
                         const Tetrahedron<Number> &tet)
    {
      Vector3<Number> x[4];
      for (int a = 0; a < 4; ++a)
        load_nodes(task.positions, task.cells.nodes + group.at(4, a), x[a]);
      Vector3<Number> edge[4]; // from node 0
      for (int a = 1; a < 4; ++a)
        for (int i = 0; i < 3; ++i)
          edge[a][i] = x[a][i] - x[0][i];
      Matrix3<Number> F; // Eq. (1)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          F[i][j] = edge[1][i] * tet.shape_gradient[1][j] + edge[2][i] * tet.shape_gradient[2][j]
                    + edge[3][i] * tet.shape_gradient[3][j];
      return F;
    }

    /// R of a group, found or loaded as the task says.
    static Matrix3<Number>
    rotation(const CellTask &task, const LaneGroup &group, const Matrix3<Number> &F)
    {
      if (task.rotation_use == RotationUse::keep
          || task.cells.strain != StrainMeasure::corotational)
        return load_rotation(task.cells, group);
      const Matrix3<Number> R = closest_rotation(F);
      if (task.rotation_use == RotationUse::update)
        for (int k = 0; k < 9; ++k)
          Lanes<Number>::store(R[k / 3][k % 3], task.cells.rotations + group.at(9, k));
      return R;
    }

    /// Call function(group) for all places of the batches.
    template <typename Function>
    static void
    for_each_group(const std::size_t begin, const std::size_t end, const Function &function)
    {
      for (std::size_t batch = begin; batch < end; ++batch)
        for (std::size_t lane = 0; lane < batch_size; lane += width)
          function(LaneGroup{ batch, lane });
    }

    template <typename Function>
    static void
    with_model(const StrainMeasure measure, const Function &function)
    {
      with_cell_model<Number>(measure, function);
    }

    static void
    update_rotations(const CellTask &task, const std::size_t begin, const std::size_t end)
    {
      CellTask updating     = task;
      updating.rotation_use = RotationUse::update;
      for_each_group(begin, end,
                     [&](const LaneGroup &group)
                     {
                       rotation(
                           updating, group,
                           deformation_gradient(task, group, load_tetrahedron(task.cells, group)));
                     });
    }

    static void
    add_rotations(const CellTask   &task,
                  const std::size_t begin,
                  const std::size_t end,
                  float            *nodal_sums)
    {
      for_each_group(begin, end,
                     [&](const LaneGroup &group)
                     {
                       const int *nodes = task.cells.nodes + group.at(4, 0);
                       if constexpr (width >= 4)
                         for (std::size_t lane = 0; lane < width; lane += 4)
                         {
                           FourFloats R[4][3];
                           load_rotations(task.cells, { group.batch, group.lane + lane }, R);
                           for (std::size_t l = 0; l < 4; ++l)
                             for (int a = 0; a < 4; ++a)
                               add_to(nodal_sums + 12 * nodes[a * batch_size + lane + l], R[l]);
                         }
                       else
                         for (std::size_t lane = 0; lane < width; ++lane)
                           for (int a = 0; a < 4; ++a)
                             for (int k = 0; k < 9; ++k)
                               nodal_sums[12 * nodes[a * batch_size + lane] + k]
                                   += static_cast<float>(
                                       task.cells.rotations[group.at(9, k) + lane]);
                     });
    }

    using FourFloats = float [[gnu::vector_size(16)]];

    /// R of four cells, each in three vectors of which the last holds one number.
    static void
    load_rotations(const CellArrays &cells, const LaneGroup &group, FourFloats (&R)[4][3])
    {
      for (int part = 0; part < 3; ++part)
      {
        Four rows[4] = {};
        for (int k = 4 * part; k < std::min(9, 4 * part + 4); ++k)
          rows[k % 4] = load_four(cells.rotations + group.at(9, k));
        transpose(rows);
        for (int l = 0; l < 4; ++l)
          R[l][part] = __builtin_convertvector(rows[l], FourFloats);
      }
    }

    static void
    add_to(float *sums, const FourFloats (&R)[3])
    {
      for (int part = 0; part < 3; ++part)
      {
        FourFloats sum;
        __builtin_memcpy(&sum, sums + 4 * part, sizeof(sum));
        sum += R[part];
        __builtin_memcpy(sums + 4 * part, &sum, sizeof(sum));
      }
    }

    static void
    closest_rotations(const std::size_t n, const float *sums, float *rotations)
    {
      for (std::size_t first = 0; first < n; first += width)
      {
        alignas(64) double lanes[9][width];
        for (int k = 0; k < 9; ++k)
          for (std::size_t lane = 0; lane < width; ++lane)
            lanes[k][lane] = sums[12 * std::min(first + lane, n - 1) + k];
        Matrix3<Number> F;
        for (int k = 0; k < 9; ++k)
          F[k / 3][k % 3] = Lanes<Number>::load(lanes[k]);
        const Matrix3<Number> R = closest_rotation(F);
        for (int k = 0; k < 9; ++k)
          Lanes<Number>::store(R[k / 3][k % 3], lanes[k]);
        for (std::size_t lane = 0; lane < width && first + lane < n; ++lane)
          for (int k = 0; k < 9; ++k)
            rotations[9 * (first + lane) + k] = static_cast<float>(lanes[k][lane]);
      }
    }

    /// The weight of example i in the cells of a group.
    static Number
    weight(const CellTask &task, const LaneGroup &group, const unsigned int i)
    {
      const ExampleArrays &examples = task.examples;
      if (examples.share_start == nullptr)
        return Number(task.weights[examples.first + i]);
      alignas(64) double sum[width] = {};
      for (std::size_t lane = 0; lane < width; ++lane)
        if (const std::size_t cell = group.batch * batch_size + group.lane + lane;
            cell < task.cells.n_cells)
          for (std::size_t s = examples.share_start[cell]; s < examples.share_start[cell + 1]; ++s)
            sum[lane]
                += examples.shares[s].value
                   * task.weights[examples.shares[s].region * examples.n_all + examples.first + i];
      return Lanes<Number>::load(sum);
    }

    /// eta E(w), of the cells of a group.
    static Matrix3<Number>
    target(const CellTask &task, const LaneGroup &group)
    {
      const ExampleArrays &examples = task.examples;
      Number               sum[6];
      for (Number &entry : sum)
        entry = Number(0.);
      for (unsigned int i = 0; i < examples.n; ++i)
      {
        if (examples.share_start == nullptr && task.weights[examples.first + i] == 0.)
          continue; // most are, of many examples on the simplex
        const Number w = weight(task, group, i) * Number(examples.importance);
        for (int k = 0; k < 6; ++k)
          sum[k] += w * load(examples.strains, group, 6 * examples.n, 6 * i + k);
      }
      return {
        { { sum[0], sum[5], sum[4] }, { sum[5], sum[1], sum[3] }, { sum[4], sum[3], sum[2] } }
      };
    }

    /// Add sign eta V T:E_i to the sums of the weights.
    static void
    add_weight_sums(const CellTask        &task,
                    const LaneGroup       &group,
                    const Number          &factor, ///< sign eta V
                    const Matrix3<Number> &T,
                    double                *weight_sums)
    {
      const ExampleArrays &examples = task.examples;
      const Number         once[6]  = { factor * T[0][0],
                                        factor * T[1][1],
                                        factor * T[2][2],
                                        factor * (T[1][2] + T[2][1]),
                                        factor * (T[0][2] + T[2][0]),
                                        factor * (T[0][1] + T[1][0]) };
      for (unsigned int i = 0; i < examples.n; ++i)
      {
        Number sum = Number(0.);
        for (int k = 0; k < 6; ++k)
          sum += once[k] * load(examples.strains, group, 6 * examples.n, 6 * i + k);
        if (examples.share_start == nullptr)
        {
          double *to = weight_sums + batch_size * (examples.first + i) + group.lane;
          Lanes<Number>::store(Lanes<Number>::load(to) + sum, to);
        }
        else
          share_out(task, group, i, sum, weight_sums);
      }
    }

    static void
    share_out(const CellTask    &task,
              const LaneGroup   &group,
              const unsigned int i,
              const Number      &sum,
              double            *weight_sums)
    {
      const ExampleArrays &examples = task.examples;
      alignas(64) double   of_cell[width];
      Lanes<Number>::store(sum, of_cell);
      for (std::size_t lane = 0; lane < width; ++lane)
        if (const std::size_t cell = group.batch * batch_size + group.lane + lane;
            cell < task.cells.n_cells)
          for (std::size_t s = examples.share_start[cell]; s < examples.share_start[cell + 1]; ++s)
            weight_sums[batch_size
                            * (examples.shares[s].region * examples.n_all + examples.first + i)
                        + group.lane + lane]
                += examples.shares[s].value * of_cell[lane];
    }

    static Number
    norm(const Matrix3<Number> &A)
    {
      return sqrt(contract(A, A));
    }

    /// The elastic constants with the damping: both are quadratics around a strain, and so
    /// is their sum.
    static CellMaterial<Number>
    damped_lame(const CellMaterial<Number> &lame, const Number &s)
    {
      const Number factor = Number(1.) + s;
      return { factor * lame.lambda, factor * lame.mu };
    }

    static Matrix3<Number>
    damped_target(const Matrix3<Number> &target, const Number &s, const Matrix3<Number> &past)
    {
      const Number factor = Number(1.) / (Number(1.) + s);
      return combine(factor, target, factor * s, past);
    }

    /// Sums over the cells, by lane.
    struct Sums
    {
      Number energy = Number(0.), elastic = Number(0.), damping = Number(0.);
      Number stress_square = Number(0.);
      Number min_det       = Number(std::numeric_limits<double>::max());
      Number inverted = Number(0.), guarded = Number(0.);

      void
      add_to(CellSums &sums) const
      {
        sums.energy += total(energy);
        sums.energy_elastic += total(elastic);
        sums.energy_damping += total(damping);
        sums.stress_square += total(stress_square);
        sums.inverted_cells += static_cast<unsigned int>(total(inverted));
        sums.guarded_cells += static_cast<unsigned int>(total(guarded));
        alignas(64) double lane[width];
        Lanes<Number>::store(min_det, lane);
        for (const double det : lane)
          sums.min_det_F = det >= sums.min_det_F ? sums.min_det_F : det; // NaN is the least
      }

      static double
      total(const Number &number)
      {
        alignas(64) double lane[width];
        Lanes<Number>::store(number, lane);
        double sum = 0.;
        for (const double value : lane)
          sum += value;
        return sum;
      }
    };

    /// Add the forces of the cells' nodes and their scales to the sums of the nodes.
    static void
    add_forces(const CellTask            &task,
               const LaneGroup           &group,
               const Tetrahedron<Number> &tet,
               const Matrix3<Number>     &VP, ///< V P
               const Number              &scale,
               double                    *nodal_sums)
    {
      alignas(64) double lanes[4][4][width];
      Vector3<Number>    last; // the forces sum to zero
      for (int a = 3; a >= 0; --a)
      {
        const Vector3<Number> force = a > 0 ? VP * tet.shape_gradient[a] : last;
        for (int i = 0; i < 3; ++i)
        {
          last[i] = a == 3 ? -force[i] : last[i] - force[i];
          Lanes<Number>::store(force[i], lanes[a][i]);
        }
        const Vector3<Number> &g = tet.shape_gradient[a];
        Lanes<Number>::store(scale * sqrt(dot(g, g)), lanes[a][3]);
      }
      for (int a = 0; a < 4; ++a)
      {
        const int *nodes = task.cells.nodes + group.at(4, a);
        if constexpr (width >= 4)
          for (std::size_t lane = 0; lane < width; lane += 4)
          {
            Four rows[4];
            for (int k = 0; k < 4; ++k)
              rows[k] = load_four(lanes[a][k] + lane);
            transpose(rows);
            for (std::size_t l = 0; l < 4; ++l)
            {
              double *sum = nodal_sums + 4 * nodes[lane + l];
              store_four(load_four(sum) + rows[l], sum);
            }
          }
        else
          for (std::size_t lane = 0; lane < width; ++lane)
            for (int k = 0; k < 4; ++k)
              nodal_sums[4 * nodes[lane] + k] += lanes[a][k][lane];
      }
    }

    template <typename Cell>
    static void
    evaluate_group(const CellTask  &task,
                   const LaneGroup &group,
                   double          *nodal_sums,
                   double          *weight_sums,
                   Sums            &sums)
    {
      const bool                 frozen       = task.cells.guard_bound == no_guard;
      const bool                 has_examples = task.examples.n_weights > 0;
      const Tetrahedron<Number>  tet          = load_tetrahedron(task.cells, group);
      const CellMaterial<Number> lame         = load_lame(task.cells, group);
      const Matrix3<Number>      F            = deformation_gradient(task, group, tet);
      const Matrix3<Number>      R            = rotation(task, group, F);
      const auto                 is_real      = tet.volume > Number(0.);
      const auto one = [](const auto &mask) { return select(mask, Number(1.), Number(0.)); };

      const Number          det = determinant(F);
      Cell                  cell(lame, R, F, task.cells.guard_bound);
      const Matrix3<Number> elastic_stress = stress(lame, cell.strain());
      const Number elastic = Number(0.5) * tet.volume * contract(elastic_stress, cell.strain());
      Number       scale   = norm(elastic_stress);
      sums.min_det         = select(det >= sums.min_det, sums.min_det, det);
      sums.inverted += one(is_real & (det <= Number(0.)));
      sums.elastic += elastic;

      // R^T P, of the elastic stress alone where nothing else is there
      Matrix3<Number> P = has_examples ? elastic_stress : cell.elastic_force();
      Matrix3<Number> D;
      if (has_examples)
      {
        D = target(task, group); // eta E(w)
        scale += norm(stress(lame, D));
        sums.stress_square += tet.volume * scale * scale;
        sums.energy += tet.volume * cell.energy(D);
        sums.guarded += one(is_real & cell.is_guarded());
        if (frozen || task.weights_are_free)
        {
          P = cell.weight_stress(D);
          if (task.weights_are_free)
            add_weight_sums(task, group, Number(-task.examples.importance) * tet.volume, P,
                            weight_sums);
        }
      }
      else
        sums.energy += elastic;

      if (task.damping.factors != nullptr)
      {
        const Number          s    = load(task.damping.factors, group, 1, 0);
        const Matrix3<Number> past = load_strain(task.damping.strains, group, 1, 0);
        sums.damping += s * tet.volume * cell.energy(past);
        scale += s * (norm(elastic_stress) + norm(stress(lame, past)));
        if (!has_examples)
          D = Matrix3<Number>{};
        D    = damped_target(D, s, past);
        cell = Cell(damped_lame(lame, s), R, F, task.cells.guard_bound);
        if (frozen)
          P = cell.weight_stress(D);
      }
      if (!frozen && (has_examples || task.damping.factors != nullptr))
      {
        cell.set_target(D);
        P = cell.force();
      }
      Matrix3<Number> RP = R * P;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          RP[i][j] *= tet.volume;
      add_forces(task, group, tet, RP, tet.volume * cell.force_factor() * scale, nodal_sums);
    }

    static void
    evaluate(const CellTask   &task,
             const std::size_t begin,
             const std::size_t end,
             double           *nodal_sums,
             double           *weight_sums,
             CellSums         &result)
    {
      Sums sums;
      with_model(task.cells.strain,
                 [&](auto model)
                 {
                   using Cell = typename decltype(model)::type;
                   for_each_group(
                       begin, end,
                       [&](const LaneGroup &group)
                       { evaluate_group<Cell>(task, group, nodal_sums, weight_sums, sums); });
                 });
      sums.add_to(result);
    }

    static void
    weight_linear_term(const CellTask   &task,
                       const std::size_t begin,
                       const std::size_t end,
                       double           *weight_sums)
    {
      with_model(task.cells.strain,
                 [&](auto model)
                 {
                   using Cell = typename decltype(model)::type;
                   for_each_group(
                       begin, end,
                       [&](const LaneGroup &group)
                       {
                         const Tetrahedron<Number> tet = load_tetrahedron(task.cells, group);
                         const Matrix3<Number>     F   = deformation_gradient(task, group, tet);
                         const Cell cell(load_lame(task.cells, group), rotation(task, group, F), F,
                                         task.cells.guard_bound);
                         add_weight_sums(task, group, Number(task.examples.importance) * tet.volume,
                                         cell.weight_stress(Matrix3<Number>{}), weight_sums);
                       });
                 });
    }

    /// A cell as it is driven, its target set.
    template <typename Cell>
    static Cell
    driven_cell(const CellTask            &task,
                const TangentTask         &tangent,
                const LaneGroup           &group,
                const Tetrahedron<Number> &tet,
                const Matrix3<Number>     &R)
    {
      CellMaterial<Number> lame = load_lame(task.cells, group);
      Matrix3<Number>      D    = target(task, group);
      if (task.damping.factors != nullptr)
      {
        const Number s = load(task.damping.factors, group, 1, 0);
        lame           = damped_lame(lame, s);
        D              = damped_target(D, s, load_strain(task.damping.strains, group, 1, 0));
      }
      Cell cell(lame, R, deformation_gradient(task, group, tet), task.cells.guard_bound);
      cell.set_target(D);
      if constexpr (std::is_same_v<Cell, GreenCell<Number>>) // the others' is R K R^T
        if (tangent.convex)
          cell.make_convex();
      return cell;
    }

    /// What makes R K R^T of the cells of a group, Eq. (8), by lane.
    struct RotatedStiffness
    {
      alignas(64) double g[4][3][width];        ///< R g_a
      alignas(64) double lambda_g[4][3][width]; ///< times V lambda
      alignas(64) double mu_g[4][3][width];     ///< times V mu
      alignas(64) double diagonal[4][4][width]; ///< V mu g_a.g_b, a >= b
    };

    static void
    find_rotated_stiffness(const CellTask &task, const LaneGroup &group, RotatedStiffness &K)
    {
      const Tetrahedron<Number>  tet    = load_tetrahedron(task.cells, group);
      const Matrix3<Number>      R      = load_rotation(task.cells, group);
      const CellMaterial<Number> lame   = load_lame(task.cells, group);
      Number                     factor = tet.volume;
      if (task.damping.factors != nullptr)
        factor *= Number(1.) + load(task.damping.factors, group, 1, 0);
      const Number    lambda = factor * lame.lambda, mu = factor * lame.mu;
      Vector3<Number> g[4];
      rotate_gradients(tet, R, g);
      for (int a = 0; a < 4; ++a)
      {
        for (int i = 0; i < 3; ++i)
        {
          Lanes<Number>::store(g[a][i], K.g[a][i]);
          Lanes<Number>::store(lambda * g[a][i], K.lambda_g[a][i]);
          Lanes<Number>::store(mu * g[a][i], K.mu_g[a][i]);
        }
        for (int b = 0; b <= a; ++b)
          Lanes<Number>::store(mu * dot(g[a], g[b]), K.diagonal[a][b]);
      }
    }

    /// Add V (lambda g_a g_b^T + mu (g_b g_a^T + (g_a.g_b) I)) of one cell, with g its rotated
    /// gradients, of which the fourth entry is 0.
    [[gnu::always_inline]] static inline void
    add_stiffness(const RotatedStiffness &K,
                  const std::size_t       lane,
                  const Four (&g)[4],
                  const int *position,
                  double    *values)
    {
      const Four unit[3] = { { 1., 0., 0., 0. }, { 0., 1., 0., 0. }, { 0., 0., 1., 0. } };
      const Four rows[3] = { { 1., 1., 1., 0. }, { 0., 1., 1., 0. }, { 0., 0., 1., 0. } };
#pragma GCC unroll 4
      for (int a = 0; a < 4; ++a)
#pragma GCC unroll 4
        for (int b = 0; b <= a; ++b)
        {
          const int *column = position + 3 * (a * (a + 1) / 2 + b);
          if (column[0] < 0) // as the others
            continue;
#pragma GCC unroll 3
          for (int j = 0; j < 3; ++j)
          {
            Four entries = g[a] * K.lambda_g[b][j][lane] + g[b] * K.mu_g[a][j][lane]
                           + unit[j] * K.diagonal[a][b][lane];
            if (a == b)
              entries *= rows[j]; // the lower triangle
            double *to = values + column[j];
            store_four(load_four(to) + entries, to);
          }
        }
    }

    static void
    add_rotated_stiffness(const CellTask    &task,
                          const TangentTask &tangent,
                          const std::size_t  begin,
                          const std::size_t  end)
    {
      RotatedStiffness K;
      for_each_group(
          begin, end,
          [&](const LaneGroup &group)
          {
            find_rotated_stiffness(task, group, K);
            constexpr std::size_t at_once = std::min<std::size_t>(4, width);
            for (std::size_t first = 0; first < width; first += at_once)
            {
              Four g[4][4]; // of node a, by cell
              for (int a = 0; a < 4; ++a)
                gradients_by_cell(K, first, a, g[a]);
              for (std::size_t l = 0; l < at_once; ++l)
              {
                const std::size_t cell = group.batch * batch_size + group.lane + first + l;
                if (cell >= task.cells.n_cells)
                  return;
                const Four g_of_cell[4] = { g[0][l], g[1][l], g[2][l], g[3][l] };
                add_stiffness(K, first + l, g_of_cell,
                              tangent.positions + n_block_columns * (cell - begin * batch_size),
                              tangent.values);
              }
            }
          });
    }

    /// The rotated gradient a of some cells, a 0 behind each.
    [[gnu::always_inline]] static inline void
    gradients_by_cell(const RotatedStiffness &K, const std::size_t first, const int a, Four (&g)[4])
    {
      if constexpr (width >= 4)
      {
        for (int i = 0; i < 3; ++i)
          g[i] = load_four(K.g[a][i] + first);
        g[3] = Four{};
        transpose(g);
      }
      else
        for (std::size_t l = 0; l < width; ++l)
          g[l] = Four{ K.g[a][0][l], K.g[a][1][l], K.g[a][2][l], 0. };
    }

    /// Columns of a block of 10, by lane, as they are added.
    using BlockColumns = double[n_block_columns][4][width];

    /// d f_a / d x_b for the cells of a group.
    template <typename Cell>
    static void
    cell_blocks(const Cell                &cell,
                const Matrix3<Number>     &R,
                const Tetrahedron<Number> &tet,
                BlockColumns              &columns)
    {
      Matrix3<Number> VR = R;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          VR[i][j] *= tet.volume;
      // node b moves by the unit vector of the rotated frame k, then by that of axis j
      for (int b = 0; b < 4; ++b)
      {
        Matrix3<Number> response[3];
        for (int k = 0; k < 3; ++k)
        {
          Matrix3<Number> M{};
          for (int l = 0; l < 3; ++l)
            M[k][l] = tet.shape_gradient[b][l];
          response[k] = VR * cell.response(M);
        }
        for (int a = b; a < 4; ++a)
        {
          Vector3<Number> force[3];
          for (int k = 0; k < 3; ++k)
            force[k] = response[k] * tet.shape_gradient[a];
          const int block = a * (a + 1) / 2 + b;
          for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 3; ++i)
              Lanes<Number>::store(a == b && i < j ? Number(0.)
                                                   : force[0][i] * R[j][0] + force[1][i] * R[j][1]
                                                         + force[2][i] * R[j][2],
                                   columns[3 * block + j][i]);
        }
      }
    }

    static void
    add_tangent(const CellTask    &task,
                const TangentTask &tangent,
                const std::size_t  begin,
                const std::size_t  end)
    {
      alignas(64) BlockColumns columns = {};
      const auto               add     = [&](const LaneGroup &group)
      {
        for (std::size_t lane = 0; lane < width; ++lane)
        {
          const std::size_t cell = group.batch * batch_size + group.lane + lane;
          if (cell >= task.cells.n_cells)
            return;
          const int *position = tangent.positions + n_block_columns * (cell - begin * batch_size);
          for (std::size_t column = 0; column < n_block_columns; ++column)
            if (position[column] >= 0)
              for (int i = 0; i < 3; ++i)
                tangent.values[position[column] + i] += columns[column][i][lane];
        }
      };
      with_model(task.cells.strain,
                 [&](auto model)
                 {
                   using Cell = typename decltype(model)::type;
                   if constexpr (!std::is_same_v<Cell, LinearCell<Number>>) // R K R^T with R = I
                     for_each_group(begin, end,
                                    [&](const LaneGroup &group)
                                    {
                                      const auto tet = load_tetrahedron(task.cells, group);
                                      const auto R   = load_rotation(task.cells, group);
                                      cell_blocks(driven_cell<Cell>(task, tangent, group, tet, R),
                                                  R, tet, columns);
                                      add(group);
                                    });
                 });
    }

    static void
    coupling(const CellTask    &task,
             const TangentTask &tangent,
             const bool         rotated,
             const std::size_t  batch,
             double            *forces)
    {
      with_model(rotated ? StrainMeasure::linear : task.cells.strain,
                 [&](auto model)
                 {
                   using Cell = typename decltype(model)::type;
                   for_each_group(
                       batch, batch + 1,
                       [&](const LaneGroup &group)
                       {
                         const Tetrahedron<Number>  tet  = load_tetrahedron(task.cells, group);
                         const Matrix3<Number>      R    = load_rotation(task.cells, group);
                         const CellMaterial<Number> lame = load_lame(task.cells, group);
                         const auto add = [&](const unsigned int i, const Number &factor,
                                              const Matrix3<Number> &dP)
                         {
                           Vector3<Number> force[4];
                           frozen_forces(tet, R, dP, force);
                           for (int a = 0; a < 4; ++a)
                             for (int c = 0; c < 3; ++c)
                               Lanes<Number>::store(factor * force[a][c],
                                                    forces + (12 * i + 3 * a + c) * batch_size
                                                        + group.lane);
                         };
                         Number factor = Number(task.examples.importance);
                         if constexpr (std::is_same_v<Cell, LinearCell<Number>>)
                           for (unsigned int i = 0; i < task.examples.n; ++i)
                             add(i, factor,
                                 stress(lame, load_strain(task.examples.strains, group,
                                                          task.examples.n, i)));
                         else
                         {
                           // the target moves by 1/(1+s) of what the examples' does
                           if (task.damping.factors != nullptr)
                             factor /= Number(1.) + load(task.damping.factors, group, 1, 0);
                           const Cell cell = driven_cell<Cell>(task, tangent, group, tet, R);
                           for (unsigned int i = 0; i < task.examples.n; ++i)
                             add(i, factor,
                                 cell.example_response(load_strain(task.examples.strains, group,
                                                                   task.examples.n, i)));
                         }
                       });
                 });
    }

    static CellKernels
    kernels(const char *name)
    {
      return { name,     update_rotations,   add_rotations,         closest_rotations,
               evaluate, weight_linear_term, add_rotated_stiffness, add_tangent,
               coupling };
    }
  };
} // namespace Exemplar

#endif
