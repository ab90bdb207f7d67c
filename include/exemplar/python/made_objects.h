// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_made_objects_h
#define exemplar_made_objects_h

#include <exemplar/exemplar.h>
#include <exemplar/python/saved_state.h>

#include <pybind11/pybind11.h>

// Objects of Python's types whose __init__ was never called, as type.__new__(type) and pickles that
// were changed make them: pybind11 would take memory that nobody has filled for their values.

namespace Exemplar::Python
{
  /// Whether pybind11 has given a value to an object of one of its types.
  inline bool
  is_made(const pybind11::handle &object)
  {
    auto *const instance = reinterpret_cast<pybind11::detail::instance *>(object.ptr());
    // the collector may look at an object that pybind11 has not laid out yet
    if (!instance->simple_layout && instance->nonsimple.status == nullptr)
      return false;
    return instance->get_value_and_holder().value_ptr() != nullptr;
  }

  /// A sentence on how to get a value of this type in Python; one for each type that has a
  /// MadeCaster.
  inline const char *
  how_to_get(const SavedState * /*type*/)
  {
    return "A State is got from a problem: problem.state.";
  }

  inline const char *
  how_to_get(const SolveReport * /*type*/)
  {
    return "A Report is what a step returns: problem.step().";
  }

  /// pybind11's caster for a class, which also refuses objects that were never made.
  template <typename T>
  struct MadeCaster : pybind11::detail::type_caster_base<T>
  {
    bool
    load(const pybind11::handle source, const bool convert)
    {
      if (pybind11::isinstance<T>(source) && !is_made(source))
        throw pybind11::type_error("This object was never made. "
                                   + std::string(how_to_get(static_cast<const T *>(nullptr))));
      return pybind11::detail::type_caster_base<T>::load(source, convert);
    }
  };
} // namespace Exemplar::Python

namespace pybind11::detail
{
  template <>
  struct type_caster<Exemplar::Python::SavedState>
      : Exemplar::Python::MadeCaster<Exemplar::Python::SavedState>
  {
  };

  template <>
  struct type_caster<Exemplar::SolveReport> : Exemplar::Python::MadeCaster<Exemplar::SolveReport>
  {
  };
} // namespace pybind11::detail

#endif
