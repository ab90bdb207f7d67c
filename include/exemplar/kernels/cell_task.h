// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_cell_task_h
#define exemplar_cell_task_h

#include <exemplar/kernels/cell_model.h>
#include <exemplar/kernels/example_arrays.h>
#include <exemplar/kernels/lanes.h>
#include <exemplar/kernels/law_functions.h>

#include <cstddef>
#include <limits>

// Input and sums of the loops over the cells. A "cell" of the loops is a quadrature point of a
// cell: linear elements have one, quadratic ones four, one after the other, which share their
// nodes. Everything is stored by batches of `batch_size` cells: entry e of cell c of a quantity
// with n entries is at (c/8 n + e) 8 + c%8.

namespace Exemplar
{
  /// The arrays of the cells; comments give the numbers a cell. The last batch is filled with
  /// copies of the last cell that have no volume. In a body of several laws the cells are looped
  /// over once for each law, with cells of other laws having no volume.
  struct CellArrays
  {
    std::size_t      n_cells;
    const int       *nodes;     ///< 4 or 10; ascending in each cell
    const double    *gradients; ///< 9 or 27: g_a of all but the first of those nodes [1/m]
    const double    *volumes;   ///< 1 [m^3]
    double          *rotations; ///< 9: R by rows
    CellLaw          law;
    const double    *constants; ///< numbers of the law's Constants
    double          *history;   ///< history variables of the law
    ExampleConstants examples;
    double           step_size;              ///< current step size [s]; 0: outside of steps
    bool             has_other_laws = false; ///< whether some cells have another law

    std::size_t
    n_batches() const
    {
      return (n_cells + batch_size - 1) / batch_size;
    }
  };

  /// Stiffness damping, which adds s C:(e - e*) to the stress.
  struct DampingArrays
  {
    const double *factors = nullptr; ///< 1: s [-]; null: no damping
    const double *strains = nullptr; ///< 6: e*
  };

  /// Terms of strongly stretched patches in their cells, Eq. (26), see StretchedPatch.
  struct StretchArrays
  {
    const double *transitions = nullptr; ///< 1: beta; null: 0 everywhere
    const double *by_F        = nullptr; ///< 1 [Pa]
    const double *stiffnesses = nullptr; ///< 1 [Pa]
    const double *elasticity  = nullptr; ///< 2: Lamé's constants of the guard [Pa]
    double       *energies    = nullptr; ///< 1: output, Gamma where beta > 0 [Pa]
  };

  /// Rare properties of the cells of a batch that patches need.
  enum CellFlags : unsigned char
  {
    thin_cells = 1, ///< some trace is extended, see ThinTrace
    long_cells = 2  ///< some |F|^2 is beyond min_stretched_square
  };

  /// Mean of J by patches, Eq. (37): output and input of the cells.
  struct VolumeArrays
  {
    double       *changes   = nullptr; ///< 1: output J - 1; null: not needed
    double       *cofactors = nullptr; ///< 9: output cof F by rows
    const double *pressures = nullptr; ///< 1: of the cell's patch, along cof F [Pa]
  };

  /// Mean dilatation by patches, Eq. (25): output and input of the cells.
  struct DilatationArrays
  {
    double        *traces    = nullptr; ///< 1: output tr(e), see ThinTrace; null: not needed
    double        *squares   = nullptr; ///< 1: output |F|^2
    unsigned char *flags     = nullptr; ///< output CellFlags of each batch
    const double  *pressures = nullptr; ///< 1: of the cell's patch [Pa]
    const double  *scales    = nullptr; ///< 1: |C:e| + eta |C:E(w)| of the volume part alone [Pa]
    StretchArrays  stretch;
    VolumeArrays   volume;
  };

  /// The derivatives b = dtheta_p/dx of the mean dilatations of patches, Eq. (25), and their
  /// layout: patch by patch four numbers for each of its nodes, the fourth 0.
  struct PatchArrays
  {
    const std::size_t  *node_starts;  ///< begin of a patch's nodes
    const std::size_t  *point_starts; ///< begin of a patch's points
    const unsigned int *points;
    const double       *fractions; ///< volume of each point over that of its patch
    const int
           *places; ///< indices in the list of nodes of all patches: of each node of a point's cell
    double *gradients; ///< b
  };

  /// A patch at a node: products of its numbers at the node with those at this and its following
  /// nodes are added to the node's matrix columns.
  struct PatchAtNode
  {
    unsigned int patch;
    unsigned int place;   ///< index of the node in the list of nodes of all patches
    std::size_t  offsets; ///< begin of its products in PatchColumns::offsets
  };

  /// Layout of the patches' outer products in the matrix: column by column, so that each value is
  /// summed by one thread, patch by patch.
  struct PatchColumns
  {
    const std::size_t *node_starts; ///< PatchArrays::node_starts
    const std::size_t *starts;      ///< begin of a node's patches
    const PatchAtNode *patches;
    const int         *columns; ///< 3 a node: where its matrix columns begin; -1: none
    const int         *offsets; ///< place of a node's rows in the first column; -1: held
    const double      *factors; ///< factors of b b^T, one a patch [J]
    const double *vectors; ///< b, with the free components first at nodes that are only partly held
    const double *squares     = nullptr; ///< dm_p/dx alike; null: no stretched patch
    const double *sums        = nullptr; ///< dXi/dx alike [N]
    const double *of_squares  = nullptr; ///< factors of dm_p/dx dm_p/dx^T, one a patch [J]
    const double *of_products = nullptr; ///< factors of dm_p/dx dXi/dx^T and its transpose
  };

  /// How a loop over the cells obtains their rotations: it uses the stored ones, or computes those
  /// of the positions and stores them, or computes them without storing, because storing takes as
  /// much memory traffic as all the rest.
  enum class RotationUse
  {
    keep,
    update,
    find_and_forget
  };

  /// What a loop finds of a LawSlope times the volume; matrices by rows.
  namespace SlopeEntry
  {
    constexpr std::size_t value = 0, by_F = 1,
                          by_gradients = 10,      ///< F^T by_F + dF^T by_dF
        by_target = 19, by_change_of_target = 25, ///< symmetric: six numbers
        by_targets_size = 31, ///< by a factor of the target and its change, where that is 1
        by_constants = 32, by_importance = 34,
                          is_guarded = 35, ///< 1: what is found counts for nothing
        size                         = 36;
  } // namespace SlopeEntry

  /// What a loop finds of the trace of the strain, which patches need.
  namespace TraceEntry
  {
    constexpr std::size_t value = 0, change = 1, square = 2, ///< |F|^2
        may_be_thin = 3, ///< 1: ThinTrace may extend the trace, which value and change lack
        size        = 4;
  } // namespace TraceEntry

  /// What a patch adds to slopes in its points, see LawChange.
  namespace PressureEntry
  {
    constexpr std::size_t value = 0, change = 1, of_target = 2, change_of_target = 3, size = 4;
  } // namespace PressureEntry

  /// Direction and output of the loop that finds slopes.
  struct SlopeTask
  {
    const double *along;             ///< changes of the positions, four numbers a node [m]
    const double *targets = nullptr; ///< 12 a cell: D and dD; null: no target
    double       *found; ///< output, SlopeEntry::size a cell; the arrays of targets, pressures and
                         ///< output begin with the first batch of the loop
    const double *pressures = nullptr; ///< PressureEntry::size a cell; null: no patches
  };

  /// Input of a loop.
  struct CellTask
  {
    CellArrays       cells;
    ExampleArrays    examples; ///< n_weights = 0: none
    DampingArrays    damping;
    DilatationArrays dilatation;
    const double    *positions = nullptr; ///< four numbers a node, the fourth unused [m]
    const int       *places = nullptr; ///< index of each node in the nodal sums; null: node numbers
    const double    *weights          = nullptr;
    RotationUse      rotation_use     = RotationUse::keep;
    bool             with_weight_sums = false; ///< whether to compute derivatives by weights
  };

  /// Sums of a loop over its cells.
  struct CellSums
  {
    double       energy           = 0.; ///< without the penalty [J]
    double       energy_elastic   = 0.; ///< sum V/2 e:C:e [J]
    double       energy_damping   = 0.; ///< [J]
    double       energy_inelastic = 0.; ///< hardening and flow [J]
    double       stress_square    = 0.; ///< sum V (|C:e| + eta |C:E(w)|)^2
    double       min_det_F        = std::numeric_limits<double>::max();
    unsigned int inverted_cells   = 0;
    unsigned int guarded_cells    = 0;

    CellSums &
    operator+=(const CellSums &other)
    {
      energy += other.energy;
      energy_elastic += other.energy_elastic;
      energy_damping += other.energy_damping;
      energy_inelastic += other.energy_inelastic;
      stress_square += other.stress_square;
      min_det_F = other.min_det_F >= min_det_F ? min_det_F : other.min_det_F; // NaN is the least
      inverted_cells += other.inverted_cells;
      guarded_cells += other.guarded_cells;
      return *this;
    }
  };

  /// Number of columns of all blocks (a,b), b <= a, of a cell's matrix: three each.
  constexpr std::size_t
  n_block_columns(const std::size_t n_nodes)
  {
    return 3 * n_nodes * (n_nodes + 1) / 2;
  }

  /// Layout of the cells' matrices in the global one. Column j of block (a,b) is added to three
  /// consecutive values, rows 0 to 2. Entries above the diagonal of the matrix count as zero, and a
  /// zero may be added to the value behind the three, because four numbers are written at once.
  struct TangentTask
  {
    bool       convex    = false;   ///< whether the tangent is never negative, instead of exact
    const int *positions = nullptr; ///< n_block_columns() a cell (all its points) from the first
                                    ///< batch on; -1: left out
    double *values = nullptr;
  };
} // namespace Exemplar

#endif
