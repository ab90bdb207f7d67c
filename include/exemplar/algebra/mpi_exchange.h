// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_mpi_exchange_h
#define exemplar_mpi_exchange_h

#include <exemplar/algebra/exchange.h>

#include <deal.II/base/partitioner.h>

#include <map>
#include <memory>
#include <mpi.h>

namespace Exemplar
{
  /// The nodes of a process. Beside their order in the files, which is that on a single process,
  /// nodes have global numbers that are consecutive for each owner.
  struct SharedNodes
  {
    std::vector<unsigned int> in_files;      ///< index of each node of this process, ascending
    std::vector<unsigned int> numbers;       ///< global number of each node
    std::vector<unsigned int> first_numbers; ///< first number of each owner, and the total

    template <typename Archive>
    void
    serialize(Archive &archive, unsigned int /*version*/)
    {
      archive &in_files &numbers &first_numbers;
    }
  };

  /// The exchange of processes that run under MPI, by deal.II's Partitioner. Sums are made in the
  /// order of the processes, so that they repeat bit for bit for the same number of them.
  class MpiExchange : public Exchange
  {
  public:
    /// Collective on `communicator`, which has as many processes as there are owners.
    MpiExchange(MPI_Comm communicator, SharedNodes nodes);

    unsigned int
    process() const override
    {
      return own_process;
    }

    unsigned int
    n_processes() const override
    {
      return nodes.first_numbers.size() - 1;
    }

    using Exchange::sum;

    void
    sum(double *own, std::size_t n) const override;

    double
    max(double own) const override;

    std::string
    first_text(std::string own) const override;

    void
    give_from_root(const std::function<std::string()>             &pack,
                   const std::function<void(const std::string &)> &unpack) const override;

    unsigned int
    n_nodes(unsigned int /*own*/) const override
    {
      return nodes.first_numbers.back();
    }

    std::vector<std::size_t>
    collect(std::vector<std::size_t> own) const override;

    std::vector<float>
    collect(std::vector<float> own, const std::vector<std::size_t> &firsts) const override;

    int
    node_here(unsigned int in_whole) const override;

    bool
    owns(const unsigned int node) const override
    {
      return is_owned[node];
    }

    void
    assemble(double *field, unsigned int n) const override;

    void
    assemble(float *field, unsigned int n) const override;

    void
    keep_owned(Vector &field) const override;

    void
    share(Vector &field) const override;

    double
    product(const Vector &a, const Vector &b) const override;

    std::vector<double>
    whole(const double *field, unsigned int n, std::size_t n_nodes, bool everywhere) const override;

    std::vector<double>
    part(std::vector<double> whole, unsigned int n) const override;

    MPI_Comm
    communicator() const override
    {
      return mpi_communicator;
    }

  private:
    using Partitioner = dealii::Utilities::MPI::Partitioner;

    /// Find the shared nodes, and number them separately, so that only these are packed and sent.
    void
    find_shared_nodes();

    /// The partitioner of fields with n numbers a shared node.
    const Partitioner &
    partitioner(unsigned int n) const;

    template <typename Number>
    void
    exchange_field(Number *field, unsigned int n, bool add_first) const;

    const MPI_Comm            mpi_communicator;
    const SharedNodes         nodes;
    const unsigned int        own_process;
    std::vector<bool>         is_owned;             ///< owner flag of each node
    std::vector<unsigned int> owned;                ///< nodes, by ascending number
    std::vector<unsigned int> shared_owned, others; ///< owned and known to others; not owned
    std::vector<unsigned int> numbers_of_others;    ///< among shared nodes, ascending
    unsigned int first_shared = 0, n_shared = 0;    ///< number of shared_owned[0]; of all processes
    mutable std::map<unsigned int, std::unique_ptr<Partitioner>> partitioners;
  };
} // namespace Exemplar

#endif
