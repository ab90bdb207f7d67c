// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/atomic_file.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/sealed_file.h>
#include <exemplar/run/output/checkpoint.h>
#include <exemplar/run/problem/obstacle_start.h>

#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/serialization/array.hpp>
#include <boost/serialization/map.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>

#include <array>
#include <fstream>
#include <new>
#include <sstream>
#include <stdexcept>

namespace Exemplar
{
  // boost requires this name

  template <typename Archive>
  void
  serialize(Archive &archive, SceneEdit &edit, const unsigned int /*version*/)
  {
    archive &edit.step &edit.before &edit.scene;
  }

  template <typename Archive>
  void
  serialize(Archive &archive, Work &work, const unsigned int /*version*/)
  {
    archive &work.handles &work.gravity &work.loads;
  }

  template <typename Archive>
  void
  serialize(Archive &archive, RunTotals &totals, const unsigned int /*version*/)
  {
    archive &totals.iterations &totals.factorizations &totals.worst_residual &totals.seconds &totals
        .first_scene &totals.edits;
  }

  template <typename Archive>
  void
  serialize(Archive &archive, Checkpoint &checkpoint, const unsigned int /*version*/)
  {
    archive &checkpoint.parameters &checkpoint.input_digests &checkpoint.state &checkpoint
        .work &checkpoint.totals &checkpoint.solver_memory &checkpoint.statistics_bytes &checkpoint
        .statistics_digest;
  }

  namespace
  {
    /// The first line. The number is increased with each change of the format.
    const std::string format = "exemplar checkpoint 15";

    const std::string without_resume = " Run the scene without --resume.";

    /// Return load(). Throws UserError if it fails although the bytes are intact: then another
    /// build of the program wrote them.
    template <typename Load>
    auto
    guarded_load(const std::filesystem::path &file, const Load &load)
    {
      const UserError foreign(file.string()
                              + " is a checkpoint that this build of exemplar cannot read."
                              + without_resume);
      try
      {
        return load();
      }
      catch (const boost::archive::archive_exception &)
      {
        throw foreign;
      }
      catch (const std::length_error &)
      {
        throw foreign;
      }
      catch (const std::bad_alloc &)
      {
        throw foreign;
      }
    }

    /// Throws UserError unless `in` begins with the first line of a checkpoint of this version;
    /// moves behind that line.
    void
    read_format(std::istream &in, const std::filesystem::path &file)
    {
      std::string found(format.size() + 1, '\0');
      in.read(found.data(), static_cast<std::streamsize>(found.size()));
      if (!in || found != format + '\n')
        throw UserError(file.string() + " is no checkpoint of this version of exemplar."
                        + without_resume);
    }
  } // namespace

  void
  save_checkpoint(const Checkpoint &checkpoint, const std::filesystem::path &file)
  {
    AtomicFile    atomic_file(file);
    SealingBuffer buffer(atomic_file.stream());
    buffer.sputn((format + '\n').data(), static_cast<std::streamsize>(format.size() + 1));
    {
      boost::archive::binary_oarchive archive(buffer);
      archive << checkpoint;
    }
    buffer.seal();
    atomic_file.commit();
  }

  Checkpoint
  load_checkpoint(const std::filesystem::path &file)
  {
    if (!std::filesystem::exists(file))
      throw UserError(
          file.string()
          + ": there is no checkpoint to resume from. Give the --output of the run that is "
            "to go on, or run the scene without --resume.");
    if (n_sealed_bytes(file) == 0) // before any of its contents are used
      throw UserError(file.string()
                      + " is damaged, or of another version: its checksum is missing or not that "
                        "of its bytes."
                      + without_resume);
    std::ifstream in(file, std::ios::binary);
    read_format(in, file);
    return guarded_load(file,
                        [&]
                        {
                          boost::archive::binary_iarchive archive(in);
                          Checkpoint                      checkpoint;
                          archive >> checkpoint;
                          return checkpoint;
                        });
  }

  void
  share(const Exchange &exchange, Checkpoint &checkpoint)
  {
    exchange.give_from_root(
        [&]
        {
          std::ostringstream out;
          {
            boost::archive::binary_oarchive archive(out);
            archive << static_cast<const Checkpoint &>(checkpoint);
          }
          return out.str();
        },
        [&](const std::string &bytes)
        {
          std::istringstream              in(bytes);
          boost::archive::binary_iarchive archive(in);
          archive >> checkpoint;
        });
  }

  void
  restore(const Checkpoint &checkpoint, const std::filesystem::path &file, Problem &problem)
  {
    guarded_load(file,
                 [&]
                 {
                   problem.resume_from(part(problem.body.mesh, checkpoint.state),
                                       checkpoint.solver_memory);
                   return true;
                 });
    check_resumed_obstacles(problem);
  }
} // namespace Exemplar
