// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_exchange_h
#define exemplar_exchange_h

#include <exemplar/algebra/vector.h>

#include <cstddef>
#include <functional>
#include <mpi.h>
#include <string>
#include <utility>
#include <vector>

namespace Exemplar
{
  /// Communication between processes that share a body. Each cell belongs to one process, so sums
  /// over cells are sums over processes. A node belongs to all processes with a cell at it, and one
  /// of them owns it. Vectors by degree of freedom hold the whole body's values at the nodes of a
  /// process, the same in all; during assembly they hold its own part until assemble(). This base
  /// class is the exchange of a single process.
  ///
  /// Functions that communicate are collective: all processes must call them, in the same order.
  class Exchange
  {
  public:
    virtual ~Exchange() = default;

    virtual unsigned int
    process() const
    {
      return 0;
    }

    virtual unsigned int
    n_processes() const
    {
      return 1;
    }

    /// The communicator of the processes that share the body.
    virtual MPI_Comm
    communicator() const
    {
      return MPI_COMM_SELF;
    }

    /// Whether this is the process that reads and writes files.
    bool
    is_root() const
    {
      return process() == 0;
    }

    /// Broadcast: the root packs bytes, all others unpack them.
    virtual void
    give_from_root(const std::function<std::string()> & /*pack*/,
                   const std::function<void(const std::string &)> & /*unpack*/) const
    {
    }

    /// Replace `own` by the sum over processes; bitwise the same on all of them.
    virtual void
    sum(double * /*own*/, std::size_t /*n*/) const
    {
    }

    double
    sum(double own) const
    {
      sum(&own, 1);
      return own;
    }

    void
    sum(std::vector<double> &own) const
    {
      sum(own.data(), own.size());
    }

    /// The greatest of the numbers that the processes give; a NaN is the greatest of all.
    virtual double
    max(const double own) const
    {
      return own;
    }

    /// Whether `own` is true on any process.
    bool
    any(const bool own) const
    {
      return max(own ? 1. : 0.) > 0.;
    }

    /// The text of the first process that has one.
    virtual std::string
    first_text(std::string own) const
    {
      return own;
    }

    /// Number of nodes of the whole body; this process has `own`.
    virtual unsigned int
    n_nodes(const unsigned int own) const
    {
      return own;
    }

    /// The vectors of all processes, concatenated in the order of processes.
    virtual std::vector<std::size_t>
    collect(std::vector<std::size_t> own) const
    {
      return own;
    }

    /// The vectors of all processes, concatenated; `firsts`, as first_numbers(), holds where each
    /// begins.
    virtual std::vector<float>
    collect(std::vector<float> own, const std::vector<std::size_t> & /*firsts*/) const
    {
      return own;
    }

    /// Local number of a node of the whole body, or -1 if this process does not have it.
    virtual int
    node_here(const unsigned int in_whole) const
    {
      return static_cast<int>(in_whole);
    }

    /// Whether this process owns a node.
    virtual bool
    owns(unsigned int /*node*/) const
    {
      return true;
    }

    /// Replace a partial sum over own cells, n numbers a node, by the sum over all cells.
    virtual void
    assemble(double * /*field*/, unsigned int /*n*/) const
    {
    }

    virtual void
    assemble(float * /*field*/, unsigned int /*n*/) const
    {
    }

    /// The inverse of assemble(): zero at the nodes that this process does not own.
    virtual void
    keep_owned(Vector & /*field*/) const
    {
    }

    /// Overwrite values at shared nodes by their owners'; three numbers a node.
    virtual void
    share(Vector & /*field*/) const
    {
    }

    /// Scalar product of two assembled fields, by degree of freedom.
    virtual double
    product(const Vector &a, const Vector &b) const
    {
      return a * b;
    }

    /// Gather a field with n numbers a node for the whole body, in the order of nodes of a single
    /// process. With `everywhere` on all processes, else at the root alone.
    virtual std::vector<double>
    whole(const double      *field,
          const unsigned int n,
          const std::size_t  n_nodes,
          bool /*everywhere*/) const
    {
      return { field, field + n * n_nodes };
    }

    /// The entries of a whole() at this process' nodes; no communication.
    virtual std::vector<double>
    part(std::vector<double> whole, unsigned int /*n*/) const
    {
      return whole;
    }

    /// The exchange of one process.
    static const Exchange &
    serial()
    {
      static const Exchange exchange;
      return exchange;
    }
  };

  /// The least of the numbers that the processes give; a NaN is the least of all.
  inline double
  min_of_all(const Exchange &exchange, const double own)
  {
    return -exchange.max(-own);
  }

  /// A partial sum over a process' own cells and nodes. A function complete(exchange, sums) turns
  /// it into the sum over all processes.
  template <typename Field>
  class OwnSums
  {
  public:
    OwnSums() = default;

    /// Starts from these values.
    explicit OwnSums(Field start) : sums(std::move(start)) {}

    /// Access for adding.
    Field *
    operator->()
    {
      return &sums;
    }

    const Field *
    operator->() const
    {
      return &sums;
    }

    Field &
    operator*()
    {
      return sums;
    }

    const Field &
    operator*() const
    {
      return sums;
    }

  private:
    Field sums;
  };

  /// Run `action` on the root alone, without communication. do_at_root() also throws its exception
  /// on all processes.
  template <typename Action>
  void
  at_root(const Exchange &exchange, const Action &action)
  {
    if (exchange.is_root())
      action();
  }

  /// Complete sums by degree of freedom, Exchange::assemble().
  inline Vector
  complete(const Exchange &exchange, OwnSums<Vector> &&sums)
  {
    exchange.assemble(sums->begin(), 3);
    return std::move(*sums);
  }

  /// Exchange::whole() of a field by degree of freedom, which may be empty in all processes.
  inline Vector
  whole(const Exchange &exchange, const Vector &field, const bool everywhere = false)
  {
    if (field.size() == 0)
      return field;
    const std::vector<double> all = exchange.whole(field.begin(), 3, field.size() / 3, everywhere);
    return Vector(all.begin(), all.end());
  }

  /// Exchange::part() of a field by degree of freedom.
  inline Vector
  part(const Exchange &exchange, const Vector &field)
  {
    if (field.size() == 0)
      return field;
    const std::vector<double> own = exchange.part({ field.begin(), field.end() }, 3);
    return Vector(own.begin(), own.end());
  }
} // namespace Exemplar

#endif
