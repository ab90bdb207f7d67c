// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_cell_task_h
#define exemplar_cell_task_h

#include <exemplar/kernels/cell_model.h>
#include <exemplar/kernels/lanes.h>

#include <cstddef>
#include <limits>

// What the loops over the cells are given and what they sum. What the loops call a cell is a quadrature
// point of a cell: of linear elements there is one, of quadratic ones there are four, one after the
// other, which share their nodes. Everything is stored by batches of `batch_size` cells: entry e of
// cell c of a quantity with n entries is at (c/8 n + e) 8 + c%8.

namespace Exemplar
{
  /// What the loops know of the cells. The last batch is filled with copies of the last
  /// cell that have no volume. In a body of several laws loops go over the cells once for each law,
  /// and cells of another law have no volume then.
  struct CellArrays
  {
    std::size_t      n_cells;
    const int       *nodes;     ///< 4 or 10; ascending in each cell
    const double    *gradients; ///< 9 or 27: g_a of all but the first of those nodes [1/m]
    const double    *volumes;   ///< 1 [m^3]
    double          *rotations; ///< 9: R by rows
    CellLaw          law;
    const double    *constants; ///< those of the law's Constants
    double          *history;   ///< what the law remembers
    ExampleConstants examples;
    double           step_size;              ///< [s]: of the step that this is in; 0: of none
    bool             has_other_laws = false; ///< some cells are of another law

    std::size_t
    n_batches() const
    {
      return (n_cells + batch_size - 1) / batch_size;
    }
  };

  /// How much of a region's weights acts in a cell.
  struct RegionShare
  {
    unsigned int region; ///< its number, in ascending order of material ids
    double       value;
  };

  /// The examples other than the rest pose, whose strain is zero.
  struct ExampleArrays
  {
    unsigned int       n           = 0; ///< of them
    unsigned int       first       = 0; ///< number of the first among all examples
    unsigned int       n_all       = 0; ///< of all
    unsigned int       n_weights   = 0;
    const double      *strains     = nullptr; ///< 6 n: xx, yy, zz, yz, xz, xy of each eta E_i
    const std::size_t *share_start = nullptr; ///< of a cell's shares; null: weights are global
    const RegionShare *shares      = nullptr;
    const float       *in_single
        = nullptr; ///< the strains once more, if single precision has them exactly
  };

  /// Stiffness damping: s(e - e*) is added to the strain's stress.
  struct DampingArrays
  {
    const double *factors = nullptr; ///< 1: s [-]; null: no damping
    const double *strains = nullptr; ///< 6: e*
  };

  /// What strongly stretched patches do to their cells, Eq. (26), see StretchedPatch.
  struct StretchArrays
  {
    const double *transitions = nullptr; ///< 1: beta; null: 0 everywhere
    const double *by_F        = nullptr; ///< 1 [Pa]
    const double *stiffnesses = nullptr; ///< 1 [Pa]
    const double *elasticity  = nullptr; ///< 2: Lamé's constants of the guard [Pa]
    double       *energies    = nullptr; ///< 1: Gamma, where beta > 0, written [Pa]
  };

  /// What of a batch patches ask for beside the numbers of its cells: hardly any cell is such.
  enum CellFlags : unsigned char
  {
    thin_cells = 1, ///< a trace was continued, see ThinTrace
    long_cells = 2  ///< |F|^2 is beyond min_stretched_square
  };

  /// Mean of J by patches, Eq. (37): what cells tell and are told.
  struct VolumeArrays
  {
    double       *changes   = nullptr; ///< 1: J - 1; null: nobody asks
    double       *cofactors = nullptr; ///< 9: cof F by rows
    const double *pressures = nullptr; ///< 1: of the cell's patch, along cof F [Pa]
  };

  /// Mean dilatation by patches, Eq. (25): what the cells tell of their volume and what they are
  /// told.
  struct DilatationArrays
  {
    double        *traces    = nullptr; ///< 1: tr(e), continued in thin cells; null: nobody asks
    double        *squares   = nullptr; ///< 1: |F|^2
    unsigned char *flags     = nullptr; ///< CellFlags of each batch, set by the same loops
    const double  *pressures = nullptr; ///< 1: of the cell's patch [Pa]
    const double  *scales    = nullptr; ///< 1: |C:e| + eta |C:E(w)| of the volume part alone [Pa]
    StretchArrays  stretch;
    VolumeArrays   volume;
  };

  /// Where the derivatives b = dtheta_p/dx of the mean dilatations of patches, Eq. (25), are: patch by
  /// patch four numbers for each of its nodes, the fourth 0.
  struct PatchArrays
  {
    const std::size_t  *node_starts;  ///< of a patch's nodes among all
    const std::size_t  *point_starts; ///< of its points
    const unsigned int *points;
    const double       *fractions; ///< of each of these in the volume of its patch
    const int
           *places; ///< of its cell's nodes, in the order of the loops, among those of all patches
    double *gradients; ///< b
  };

  /// A patch at a node: the product of its numbers at the node with those at all nodes from there on goes
  /// to the columns of the node.
  struct PatchAtNode
  {
    unsigned int patch;
    unsigned int place;   ///< of the node among those of all patches
    std::size_t  offsets; ///< of the first of these products
  };

  /// Where the products of the patches go in the matrix: column by column, so that each value is summed
  /// by one thread, patch by patch.
  struct PatchColumns
  {
    const std::size_t *node_starts; ///< as PatchArrays
    const std::size_t *starts;      ///< of a node's patches
    const PatchAtNode *patches;
    const int         *columns; ///< 3 a node: where its columns begin in the values; -1 for none
    const int         *offsets; ///< of rows in the first of them, a node; -1: held
    const double      *factors; ///< of b b^T, a patch [J]
    const double *vectors; ///< b, at nodes of which some components are held the free ones first
    const double *squares     = nullptr; ///< dm_p/dx alike; null: no patch is stretched
    const double *sums        = nullptr; ///< the derivative of Xi [N]
    const double *of_squares  = nullptr; ///< factors of the square of the one, a patch [J]
    const double *of_products = nullptr; ///< and of both products of one with the other
  };

  /// What a loop over the cells does with their rotations: it takes those that are stored, or it
  /// finds those of the positions and stores them, or it finds them for itself alone, because
  /// storing them takes as much memory traffic as all the rest.
  enum class RotationUse
  {
    keep,
    update,
    find_and_forget
  };

  /// A loop's input.
  struct CellTask
  {
    CellArrays       cells;
    ExampleArrays    examples; ///< n_weights = 0: none
    DampingArrays    damping;
    DilatationArrays dilatation;
    const double    *positions = nullptr; ///< four numbers a node, the fourth unused [m]
    const int       *places = nullptr; ///< of a cell's nodes in the nodal sums; null: their numbers
    const double    *weights          = nullptr;
    RotationUse      rotation_use     = RotationUse::keep;
    bool             with_weight_sums = false; ///< for the derivatives by weights
  };

  /// What a loop sums over its cells.
  struct CellSums
  {
    double       energy           = 0.; ///< without the penalty [J]
    double       energy_elastic   = 0.; ///< sum V/2 e:C:e [J]
    double       energy_damping   = 0.; ///< [J]
    double       energy_inelastic = 0.; ///< that laws have beside it and the examples [J]
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

  /// Columns of the blocks (a,b), b <= a, of a cell's matrix: three each.
  constexpr std::size_t
  n_block_columns(const std::size_t n_nodes)
  {
    return 3 * n_nodes * (n_nodes + 1) / 2;
  }

  /// Where the cells' matrices go. Column j of block (a,b) is added to three consecutive values,
  /// rows 0 to 2. Entries above the diagonal of the matrix count as zero, and a zero may be added
  /// to the value behind the three, because four numbers are written at once.
  struct TangentTask
  {
    bool       convex    = false; ///< make_convex() the models whose convex tangent is not R K R^T
    const int *positions = nullptr; ///< n_block_columns() a cell (all its points) from the first
                                    ///< batch on; -1: left out
    double *values = nullptr;
  };
} // namespace Exemplar

#endif
