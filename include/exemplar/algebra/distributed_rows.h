// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_distributed_rows_h
#define exemplar_distributed_rows_h

#include <exemplar/algebra/halo.h>
#include <exemplar/algebra/spd_operator.h>

#include <map>
#include <vector>

namespace Exemplar
{
  /// The matrix rows that a process owns: three for every node that it owns and that is not wholly
  /// held. Global numbers are consecutive for each process, one process after the other.
  class RowNumbers
  {
  public:
    /// `free_dofs` must outlive this. Throws SolverFailure, in all processes, if there are more
    /// rows than an int counts.
    explicit RowNumbers(const FreeDofs &free_dofs);

    unsigned int
    n_rows() const
    {
      return 3 * own_nodes.size();
    }

    /// Global number of the first owned row.
    int
    first_row() const;

    bool
    is_own(const int global_row) const
    {
      return global_row >= first_row() && global_row < first_row() + static_cast<int>(n_rows());
    }

    /// The process that owns a row.
    unsigned int
    owner(int global_row) const;

    /// The exchange with the processes that own the other rows.
    const Exchange &
    exchange() const
    {
      return with_others;
    }

    /// The nodes with owned rows.
    const std::vector<unsigned int> &
    nodes() const
    {
      return own_nodes;
    }

    /// Local number of the owned row of each unknown.
    const std::vector<int> &
    row_of() const
    {
      return own_row_of;
    }

    /// Global row of each entry of FreeDofs::local_list(), the free degrees of freedom of this
    /// process' nodes.
    const std::vector<int> &
    global_rows() const
    {
      return rows_of_free;
    }

    /// first_numbers() of the nodes with owned rows.
    const std::vector<std::size_t> &
    first_nodes() const
    {
      return firsts;
    }

  private:
    const Exchange           &with_others;
    std::vector<unsigned int> own_nodes;
    std::vector<int>          own_row_of, rows_of_free;
    std::vector<std::size_t>  firsts;
  };

  /// A sparse matrix in compressed row storage.
  struct CsrMatrix
  {
    std::vector<int>    row_start; ///< one more than there are rows
    std::vector<int>    column;    ///< column of each entry, ascending in a row
    std::vector<double> value;
  };

  /// A symmetric sparse matrix distributed by rows, to which the cells of several processes add, in
  /// a format that libraries take without copying. Local column numbers are those of the owned
  /// rows, then those of the other nodes that these are coupled with, three a node. Not all of the
  /// latter are nodes of this process' cells: other processes' cells couple shared nodes with nodes
  /// that are theirs alone. Rows of held components are rows of the unit matrix.
  class DistributedRows
  {
  public:
    /// `free_dofs` must outlive this. All processes must call this and the functions that change it
    /// or multiply.
    explicit DistributedRows(const FreeDofs &free_dofs) : numbers(free_dofs) {}

    /// Set the pattern: the lower triangle of the couplings of this process' cells, which must
    /// outlive this. Throws SolverFailure, in all processes, if there are more entries than an int
    /// counts.
    void
    reinit(const SymmetricPattern &lower_pattern);

    /// Sum up the values of the lower triangle, to which each process gives its cells' part. Throws
    /// SolverFailure, in all processes, if a diagonal entry is not positive, including
    /// `further_diagonal`, by owned row, of summands that are not assembled.
    void
    fill(const std::vector<double> &lower_values, const std::vector<double> &further_diagonal = {});

    /// image = A vector, by own rows.
    void
    multiply(const Vector &vector, Vector &image) const;

    /// Memory in bytes.
    std::size_t
    memory_consumption() const;

    /// Global number of each local column.
    std::vector<int>
    global_columns() const;

    const RowNumbers &
    get_numbers() const
    {
      return numbers;
    }

    /// The owned rows, with local column numbers. A library may point at it until reinit().
    CsrMatrix &
    get_matrix()
    {
      return matrix;
    }

  private:
    /// Lists for other processes, or from them, by their numbers.
    template <typename Number>
    using ByProcess = std::map<unsigned int, std::vector<Number>>;

    /// Row and column numbers, alternating, of this process' contributions to other processes'
    /// rows; remembers the positions of these values.
    ByProcess<int>
    list_foreign();

    void
    number_columns(const ByProcess<int> &received);

    /// The local number of a column.
    int
    column_of(int global_column) const;

    void
    insert_couplings(const ByProcess<int> &received);

    /// Sort the columns of each row, and remove duplicates.
    void
    tidy_rows();

    /// Find where the values that other processes send are added.
    void
    find_places(const ByProcess<int> &received);

    void
    add_own(const std::vector<double> &lower_values);

    void
    add_received(const std::vector<double> &lower_values);

    void
    check_diagonal(const std::vector<double> &further_diagonal) const;

    /// Position of an entry of the pattern.
    int
    place_of(int row, int local_column) const;

    /// Call action(row, column, entry) for all entries of both triangles of this process' pattern,
    /// numbered by `by`; in each row the columns ascend by degree of freedom.
    template <typename Action>
    void
    for_each_entry(const std::vector<int> &by, const Action &action) const;

    /// Call action(row, column), by local numbers, for all couplings of owned rows.
    template <typename Action>
    void
    for_each_coupling(const ByProcess<int> &received, const Action &action) const;

    const RowNumbers         numbers;
    CsrMatrix                matrix;
    const SymmetricPattern  *pattern = nullptr;
    std::vector<int>         local_columns;      ///< columns of FreeDofs::local_list()
    std::vector<std::size_t> other_nodes;        ///< global numbers of ghost nodes, ascending
    ByProcess<int>           foreign_entries;    ///< entries of the pattern in others' rows
    ByProcess<int>           places_of_received; ///< positions among the values, by sender
    Halo                     halo;
  };
} // namespace Exemplar

#endif
