// SPDX-License-Identifier: GPL-3.0-or-later
// Preloaded into each process under mpirun, this library writes what collective functions of MPI the
// process calls, a line a call and before it, so that the lines of one that hangs or dies are there:
// in the file rank.N of the directory that COLLECTIVES names, N its number. Lines have the name
// of the communicator, the function, and what must be the same in all processes. Only calls on communicators of
// several processes count. Calls from one process to another do not.
// tests/scenes/mpirun.py compares the files.

#include <cstdlib>
#include <fcntl.h>
#include <map>
#include <mpi.h>
#include <mutex>
#include <string>
#include <unistd.h>

namespace
{
  std::mutex one_at_a_time;

  /// Communicators have the name of that from which they were made, and a number.
  struct Known
  {
    std::string name;
    int         n_made = 0;
  };

  std::map<MPI_Comm, Known> &
  communicators()
  {
    static std::map<MPI_Comm, Known> all{ { MPI_COMM_WORLD, { "world" } } };
    return all;
  }

  int
  size_of(MPI_Comm communicator)
  {
    int size = 0;
    PMPI_Comm_size(communicator, &size);
    return size;
  }

  /// The file of this process; -1 if nobody asks for it.
  int
  open_file()
  {
    const char *const directory = std::getenv("COLLECTIVES");
    if (directory == nullptr)
      return -1;
    int rank = 0;
    PMPI_Comm_rank(MPI_COMM_WORLD, &rank);
    const std::string name = std::string(directory) + "/rank." + std::to_string(rank);
    return open(name.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
  }

  void
  note(MPI_Comm communicator, const std::string &call)
  {
    if (size_of(communicator) < 2)
      return;
    const std::lock_guard<std::mutex> lock(one_at_a_time);
    static const int                  file = open_file();
    const std::string                 line = communicators()[communicator].name + ' ' + call + '\n';
    if (file >= 0 && write(file, line.data(), line.size()) < 0)
      std::abort(); // the disk is full, and the test worth nothing
  }

  void
  name_new(MPI_Comm from, MPI_Comm made, const std::string &which = "")
  {
    if (made == MPI_COMM_NULL)
      return;
    const std::lock_guard<std::mutex> lock(one_at_a_time);
    Known                            &before = communicators()[from];
    communicators()[made] = { before.name + '/' + std::to_string(++before.n_made) + which, 0 };
  }

  std::string
  numbers(const long long count, MPI_Datatype type)
  {
    char name[MPI_MAX_OBJECT_NAME] = "";
    int  length = 0, size = 0;
    PMPI_Type_get_name(type, name, &length);
    PMPI_Type_size(type, &size);
    return std::to_string(count) + " x "
           + (length > 0 ? std::string(name) : std::to_string(size) + " bytes");
  }

  /// Of what processes give in parts of any size: all together.
  std::string
  numbers(const int *counts, MPI_Datatype type, MPI_Comm communicator)
  {
    long long sum = 0;
    for (int process = 0; process < size_of(communicator); ++process)
      sum += counts[process];
    return numbers(sum, type);
  }

  std::string
  by(MPI_Op op)
  {
    const std::map<MPI_Op, const char *> names
        = { { MPI_SUM, "SUM" },      { MPI_MAX, "MAX" },   { MPI_MIN, "MIN" },
            { MPI_PROD, "PROD" },    { MPI_LAND, "LAND" }, { MPI_LOR, "LOR" },
            { MPI_BAND, "BAND" },    { MPI_BOR, "BOR" },   { MPI_MAXLOC, "MAXLOC" },
            { MPI_MINLOC, "MINLOC" } };
    const auto found = names.find(op);
    return std::string(", ") + (found == names.end() ? "an operation" : found->second);
  }

  std::string
  at(const int root)
  {
    return "root " + std::to_string(root);
  }
} // namespace

// The functions themselves. Each notes, and then does what it is asked for by the name with P.

#define NOTED(name, communicator, what, ...)                                                       \
  (note(communicator, std::string(#name "(") + (what) + ")"), PMPI_##name(__VA_ARGS__))

extern "C"
{
  int
  MPI_Barrier(MPI_Comm c)
  {
    return NOTED(Barrier, c, "", c);
  }

  int
  MPI_Ibarrier(MPI_Comm c, MPI_Request *r)
  {
    return NOTED(Ibarrier, c, "", c, r);
  }

  int
  MPI_Bcast(void *b, int n, MPI_Datatype t, int root, MPI_Comm c)
  {
    return NOTED(Bcast, c, numbers(n, t) + ", " + at(root), b, n, t, root, c);
  }

  int
  MPI_Allreduce(const void *a, void *b, int n, MPI_Datatype t, MPI_Op op, MPI_Comm c)
  {
    return NOTED(Allreduce, c, numbers(n, t) + by(op), a, b, n, t, op, c);
  }

  int
  MPI_Iallreduce(
      const void *a, void *b, int n, MPI_Datatype t, MPI_Op op, MPI_Comm c, MPI_Request *r)
  {
    return NOTED(Iallreduce, c, numbers(n, t) + by(op), a, b, n, t, op, c, r);
  }

  int
  MPI_Reduce(const void *a, void *b, int n, MPI_Datatype t, MPI_Op op, int root, MPI_Comm c)
  {
    return NOTED(Reduce, c, numbers(n, t) + by(op) + ", " + at(root), a, b, n, t, op, root, c);
  }

  int
  MPI_Reduce_scatter(const void *a, void *b, const int *n, MPI_Datatype t, MPI_Op op, MPI_Comm c)
  {
    return NOTED(Reduce_scatter, c, numbers(n, t, c) + by(op), a, b, n, t, op, c);
  }

  int
  MPI_Reduce_scatter_block(const void *a, void *b, int n, MPI_Datatype t, MPI_Op op, MPI_Comm c)
  {
    return NOTED(Reduce_scatter_block, c, numbers(n, t) + by(op), a, b, n, t, op, c);
  }

  int
  MPI_Scan(const void *a, void *b, int n, MPI_Datatype t, MPI_Op op, MPI_Comm c)
  {
    return NOTED(Scan, c, numbers(n, t) + by(op), a, b, n, t, op, c);
  }

  int
  MPI_Exscan(const void *a, void *b, int n, MPI_Datatype t, MPI_Op op, MPI_Comm c)
  {
    return NOTED(Exscan, c, numbers(n, t) + by(op), a, b, n, t, op, c);
  }

  // what is received is the same in all, also where a process gives from the same place
  int
  MPI_Allgather(const void *a, int n, MPI_Datatype t, void *b, int m, MPI_Datatype u, MPI_Comm c)
  {
    return NOTED(Allgather, c, numbers(m, u), a, n, t, b, m, u, c);
  }

  int
  MPI_Allgatherv(const void  *a,
                 int          n,
                 MPI_Datatype t,
                 void        *b,
                 const int   *m,
                 const int   *d,
                 MPI_Datatype u,
                 MPI_Comm     c)
  {
    return NOTED(Allgatherv, c, numbers(m, u, c), a, n, t, b, m, d, u, c);
  }

  int
  MPI_Alltoall(const void *a, int n, MPI_Datatype t, void *b, int m, MPI_Datatype u, MPI_Comm c)
  {
    return NOTED(Alltoall, c, numbers(m, u), a, n, t, b, m, u, c);
  }

  // from here on what a process gives and receives may be its own matter
  int
  MPI_Alltoallv(const void  *a,
                const int   *n,
                const int   *d,
                MPI_Datatype t,
                void        *b,
                const int   *m,
                const int   *e,
                MPI_Datatype u,
                MPI_Comm     c)
  {
    return NOTED(Alltoallv, c, "", a, n, d, t, b, m, e, u, c);
  }

  int
  MPI_Gather(
      const void *a, int n, MPI_Datatype t, void *b, int m, MPI_Datatype u, int root, MPI_Comm c)
  {
    return NOTED(Gather, c, at(root), a, n, t, b, m, u, root, c);
  }

  int
  MPI_Gatherv(const void  *a,
              int          n,
              MPI_Datatype t,
              void        *b,
              const int   *m,
              const int   *d,
              MPI_Datatype u,
              int          root,
              MPI_Comm     c)
  {
    return NOTED(Gatherv, c, at(root), a, n, t, b, m, d, u, root, c);
  }

  int
  MPI_Scatter(
      const void *a, int n, MPI_Datatype t, void *b, int m, MPI_Datatype u, int root, MPI_Comm c)
  {
    return NOTED(Scatter, c, at(root), a, n, t, b, m, u, root, c);
  }

  int
  MPI_Scatterv(const void  *a,
               const int   *n,
               const int   *d,
               MPI_Datatype t,
               void        *b,
               int          m,
               MPI_Datatype u,
               int          root,
               MPI_Comm     c)
  {
    return NOTED(Scatterv, c, at(root), a, n, d, t, b, m, u, root, c);
  }

  int
  MPI_Comm_free(MPI_Comm *c)
  {
    return NOTED(Comm_free, *c, "", c);
  }

  int
  MPI_Comm_dup(MPI_Comm c, MPI_Comm *made)
  {
    const int status = NOTED(Comm_dup, c, "", c, made);
    name_new(c, *made);
    return status;
  }

  int
  MPI_Comm_create(MPI_Comm c, MPI_Group group, MPI_Comm *made)
  {
    const int status = NOTED(Comm_create, c, "", c, group, made);
    name_new(c, *made);
    return status;
  }

  int
  MPI_Comm_split(MPI_Comm c, int color, int key, MPI_Comm *made)
  {
    const int status = NOTED(Comm_split, c, "", c, color, key, made);
    name_new(c, *made, "of" + std::to_string(color));
    return status;
  }

  int
  MPI_Comm_split_type(MPI_Comm c, int type, int key, MPI_Info info, MPI_Comm *made)
  {
    const int status = NOTED(Comm_split_type, c, "", c, type, key, info, made);
    name_new(c, *made);
    return status;
  }
}
