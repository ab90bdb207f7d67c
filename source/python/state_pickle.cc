// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/sealed_file.h>
#include <exemplar/base/version.h>
#include <exemplar/python/state_pickle.h>

#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/serialization/vector.hpp>
#include <fmt/core.h>

#include <sstream>

namespace Exemplar::Python
{
  namespace py = pybind11;

  namespace
  {
    /// The serialized version and state, as bytes to be sealed.
    std::string
    bytes_of(const SavedState &saved)
    {
      std::ostringstream bytes;
      bytes << EXEMPLAR_VERSION << '\n';
      boost::archive::binary_oarchive(bytes) << saved;
      return bytes.str();
    }

    SavedState
    state_in(std::istream &bytes)
    {
      SavedState saved;
      try
      {
        boost::archive::binary_iarchive(bytes) >> saved;
      }
      catch (
          const std::exception &error) // intact, but written by a machine or library that differs
      {
        throw UserError(fmt::format("The state was pickled by another build of exemplar {}, of "
                                    "which this one cannot read the bytes ({}). Keep arrays to "
                                    "carry it over: positions, velocities, weights, time.",
                                    EXEMPLAR_VERSION, error.what()));
      }
      return saved;
    }
  } // namespace

  py::object
  pickled(const SavedState &saved)
  {
    return py::bytes(sealed(bytes_of(saved)));
  }

  SavedState
  unpickled(const py::object &kept)
  {
    const auto whole = py::isinstance<py::bytes>(kept) ? unsealed(kept.cast<std::string>())
                                                       : std::optional<std::string>();
    if (!whole)
      throw UserError(
          "The pickle of an exemplar.State is damaged, or of an earlier exemplar, whose "
          "pickles had no digest. Pickle the state anew, and keep arrays to read it "
          "for years: positions, velocities, weights, time.");
    std::istringstream bytes(*whole);
    std::string        version;
    std::getline(bytes, version);
    if (version != EXEMPLAR_VERSION)
      throw UserError(fmt::format("The state was pickled by exemplar {}, but this is {}. Keep "
                                  "arrays to read it later: positions, velocities, weights, time.",
                                  version, EXEMPLAR_VERSION));
    return state_in(bytes);
  }
} // namespace Exemplar::Python
