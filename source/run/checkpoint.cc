// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/atomic_file.h>
#include <exemplar/base/errors.h>
#include <exemplar/run/checkpoint.h>

#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/serialization/array.hpp>
#include <boost/serialization/map.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>

#include <fstream>
#include <new>
#include <stdexcept>

namespace Exemplar
{
  namespace
  {
    const std::string format = "exemplar checkpoint 4";

    template <typename Archive>
    void
    transfer(Archive &archive, Checkpoint &checkpoint)
    {
      State     &state  = checkpoint.state;
      Work      &work   = checkpoint.work;
      RunTotals &totals = checkpoint.totals;
      archive &checkpoint.parameters &checkpoint.input_digests;
      archive &state.step &state.time &state.positions &state.velocities &state
          .previous_positions &state.previous_velocities &state.previous_step &state.weights &state
          .multipliers;
      archive &work.handles &work.gravity &work.loads;
      archive &totals.iterations &totals.factorizations &totals.worst_residual;
      for (double &seconds : totals.seconds)
        archive &seconds;
      archive &checkpoint.solver_memory &checkpoint.statistics_bytes;
    }

    /// What `load` returns. Throws UserError if the bytes of the file are not a checkpoint's: the
    /// archive notices it, or takes some of them for the size of a vector that is too large.
    template <typename Load>
    auto
    guarded_load(const std::filesystem::path &file, const Load &load)
    {
      const UserError broken(file.string()
                             + " cannot be read as a checkpoint. Run the scene without --resume.");
      try
      {
        return load();
      }
      catch (const boost::archive::archive_exception &)
      {
        throw broken;
      }
      catch (const std::length_error &)
      {
        throw broken;
      }
      catch (const std::bad_alloc &)
      {
        throw broken;
      }
    }
  } // namespace

  void
  save_checkpoint(const Checkpoint &checkpoint, const std::filesystem::path &file)
  {
    AtomicFile atomic_file(file);
    {
      boost::archive::binary_oarchive archive(atomic_file.stream());
      archive                        &format;
      transfer(archive, const_cast<Checkpoint &>(checkpoint)); // saving does not change it
    }
    atomic_file.commit();
  }

  Checkpoint
  load_checkpoint(const std::filesystem::path &file)
  {
    std::ifstream in(file, std::ios::binary);
    if (!in)
      throw UserError(file.string()
                      + ": there is no checkpoint to resume from. Run the scene "
                        "without --resume.");
    return guarded_load(file,
                        [&]
                        {
                          boost::archive::binary_iarchive archive(in);
                          std::string                     found;
                          archive                        &found;
                          if (found != format)
                            throw UserError(
                                file.string()
                                + " is no checkpoint of this version of exemplar. Run the "
                                  "scene without --resume.");
                          Checkpoint checkpoint;
                          transfer(archive, checkpoint);
                          return checkpoint;
                        });
  }

  void
  restore(const Checkpoint &checkpoint, const std::filesystem::path &file, Problem &problem)
  {
    guarded_load(file,
                 [&]
                 {
                   problem.resume_from(checkpoint.state, checkpoint.solver_memory);
                   return true;
                 });
  }
} // namespace Exemplar
