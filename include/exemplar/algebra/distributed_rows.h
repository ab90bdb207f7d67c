// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_distributed_rows_h
#define exemplar_distributed_rows_h

#include <exemplar/algebra/halo.h>
#include <exemplar/algebra/spd_operator.h>

#include <map>
#include <vector>

namespace Exemplar
{
  /// The rows that a process has of a matrix: three for every node that it owns and that is not held
  /// as a whole. Among all processes they are numbered one process after the other.
  class RowNumbers
  {
  public:
    /// `free_dofs` must outlive this. Throws SolverFailure, in all processes, if there are more rows
    /// than an int counts.
    explicit RowNumbers(const FreeDofs &free_dofs);

    unsigned int
    n_rows() const
    {
      return 3 * own_nodes.size();
    }

    /// Number of the first of the own rows.
    int
    first_row() const;

    bool
    is_own(const int global_row) const
    {
      return global_row >= first_row() && global_row < first_row() + static_cast<int>(n_rows());
    }

    /// The process that has a row.
    unsigned int
    owner(int global_row) const;

    /// With the processes that have the other rows.
    const Exchange &
    exchange() const
    {
      return with_others;
    }

    /// Those with own rows.
    const std::vector<unsigned int> &
    nodes() const
    {
      return own_nodes;
    }

    /// The own row, by local number, of each unknown.
    const std::vector<int> &
    row_of() const
    {
      return own_row_of;
    }

    /// Of all free degrees of freedom of this process' nodes, FreeDofs::local_list().
    const std::vector<int> &
    global_rows() const
    {
      return rows_of_free;
    }

    /// As first_numbers() of the nodes with rows.
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

  /// A sparse matrix by rows, one after the other.
  struct CsrMatrix
  {
    std::vector<int>    row_start; ///< one more than there are rows
    std::vector<int>    column;    ///< of each entry, ascending in a row
    std::vector<double> value;
  };

  /// A symmetric sparse matrix by rows, to which the cells of several processes add: no library's, but
  /// in the form that libraries take. Columns have local numbers: those of the own rows, then those
  /// of the other nodes that they are coupled with, three a node. Not all of these are nodes of this
  /// process' cells: the cells of others couple shared nodes with nodes that are theirs alone. In
  /// the row of a held component is the unit matrix.
  class DistributedRows
  {
  public:
    /// `free_dofs` must outlive this. All processes must call this and the functions that change it
    /// or multiply.
    explicit DistributedRows(const FreeDofs &free_dofs) : numbers(free_dofs) {}

    /// The lower triangle of what this process' cells couple; it must outlive this. Throws
    /// SolverFailure, in all processes, if there are more entries than an int counts.
    void
    reinit(const SymmetricPattern &lower_pattern);

    /// From the values of the lower triangle, of which each process has its cells' part. Throws
    /// SolverFailure, in all processes, if an entry of the diagonal is not positive, together with what
    /// summands that are not assembled have there, by own row.
    void
    fill(const std::vector<double> &lower_values, const std::vector<double> &further_diagonal = {});

    /// image = A vector, by own rows.
    void
    multiply(const Vector &vector, Vector &image) const;

    /// In bytes.
    std::size_t
    memory_consumption() const;

    /// By local number.
    std::vector<int>
    global_columns() const;

    const RowNumbers &
    get_numbers() const
    {
      return numbers;
    }

    /// The own rows, with columns by local number. A library may point at it until reinit().
    CsrMatrix &
    get_matrix()
    {
      return matrix;
    }

  private:
    /// Lists for other processes, or from them, by their numbers.
    template <typename Number>
    using ByProcess = std::map<unsigned int, std::vector<Number>>;

    /// Row and column, one after the other, of what this process' cells add to the rows of others;
    /// remembers where these values are.
    ByProcess<int>
    list_foreign();

    void
    number_columns(const ByProcess<int> &received);

    /// The local number of a column.
    int
    column_of(int global_column) const;

    void
    insert_couplings(const ByProcess<int> &received);

    /// Sort the columns of each row, and leave each once.
    void
    tidy_rows();

    /// Where the values go that other processes send.
    void
    find_places(const ByProcess<int> &received);

    void
    add_own(const std::vector<double> &lower_values);

    void
    add_received(const std::vector<double> &lower_values);

    void
    check_diagonal(const std::vector<double> &further_diagonal) const;

    /// Of a row and a column that there are.
    int
    place_of(int row, int local_column) const;

    /// Call action(row, column, entry) for all entries of both triangles of what this process' cells
    /// couple, by the numbers of `by`; in each row the columns ascend by the order of the degrees of
    /// freedom.
    template <typename Action>
    void
    for_each_entry(const std::vector<int> &by, const Action &action) const;

    /// Call action(row, column), by local numbers, for all couplings of own rows.
    template <typename Action>
    void
    for_each_coupling(const ByProcess<int> &received, const Action &action) const;

    const RowNumbers         numbers;
    CsrMatrix                matrix;
    const SymmetricPattern  *pattern = nullptr;
    std::vector<int>         local_columns;      ///< of each free degree of freedom of the nodes
    std::vector<std::size_t> other_nodes;        ///< their numbers, ascending
    ByProcess<int>           foreign_entries;    ///< of the pattern, parts of the rows of others
    ByProcess<int>           places_of_received; ///< among the values, of what others send
    Halo                     halo;
  };
} // namespace Exemplar

#endif
