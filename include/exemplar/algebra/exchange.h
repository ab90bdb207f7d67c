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
  /// What processes that share a body tell each other. Each cell belongs to one process, so what is
  /// summed over cells is a sum over processes. A node belongs to all processes with a cell at it,
  /// and one of them owns it. Vectors by degree of freedom hold the whole body's values at the nodes
  /// of a process, the same in all; while they are summed cell by cell, they hold its own part
  /// until assemble(). This base is the exchange of one process, which has nobody to talk to.
  ///
  /// Functions that talk must be called by all processes, in the same order.
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

    /// Of the processes.
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

    /// Give all others bytes of the root, who packs them.
    virtual void
    give_from_root(const std::function<std::string()> & /*pack*/,
                   const std::function<void(const std::string &)> & /*unpack*/) const
    {
    }

    /// Add up what the processes give; the same on all of them, bit for bit.
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

    /// Whether it is so in any process.
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

    /// Nodes of the whole body, of which this process has `own`.
    virtual unsigned int
    n_nodes(const unsigned int own) const
    {
      return own;
    }

    /// What all processes give, one after the other.
    virtual std::vector<std::size_t>
    collect(std::vector<std::size_t> own) const
    {
      return own;
    }

    /// The same where all know how many each gives, and need not tell: as first_numbers() of them.
    virtual std::vector<float>
    collect(std::vector<float> own, const std::vector<std::size_t> & /*firsts*/) const
    {
      return own;
    }

    /// The number in this process of a node of the whole body, or -1 if it is not there.
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

    /// Of a field with n numbers a node that is a part of the sum over cells, make the sum.
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

    /// The owners' values to all who share a node; three numbers a node.
    virtual void
    share(Vector & /*field*/) const
    {
    }

    /// The product of two fields of assembled values, by degree of freedom.
    virtual double
    product(const Vector &a, const Vector &b) const
    {
      return a * b;
    }

    /// A field with n numbers a node, for all nodes of the body in the order of one process. With
    /// `everywhere` all processes have it, else the root alone.
    virtual std::vector<double>
    whole(const double      *field,
          const unsigned int n,
          const std::size_t  n_nodes,
          bool /*everywhere*/) const
    {
      return { field, field + n * n_nodes };
    }

    /// What of a whole() this process has; talks to nobody.
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

  /// What a process has summed over its own cells and nodes, and is not yet the body's: to become that
  /// it must be given to a function complete(exchange, sums), which makes the sum over processes.
  template <typename Field>
  class OwnSums
  {
  public:
    OwnSums() = default;

    /// From these on.
    explicit OwnSums(Field start) : sums(std::move(start)) {}

    /// To add to them.
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

  /// Do what the root does alone; talks to nobody. do_at_root() throws in all processes what it throws.
  template <typename Action>
  void
  at_root(const Exchange &exchange, const Action &action)
  {
    if (exchange.is_root())
      action();
  }

  /// Sums by degree of freedom.
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
