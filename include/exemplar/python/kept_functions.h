// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_kept_functions_h
#define exemplar_kept_functions_h

#include <pybind11/pybind11.h>

#include <list>
#include <map>
#include <string>

namespace Exemplar::Python
{
  /// The Python function of a term of the user's.
  struct KeptTerm
  {
    pybind11::object function;
    bool             is_checked = false; ///< whether its gradient was, where it acts
  };

  /// The Python functions that a problem calls. Their addresses do not change.
  struct KeptFunctions
  {
    std::map<std::string, pybind11::object> motions; ///< functions by name of handle
    std::list<KeptTerm>                     terms;
    pybind11::object                        callback = pybind11::none(); ///< on_iteration()'s

    /// Calls visit(function, arg) for all functions, for Python's garbage collector.
    int
    visit(const visitproc visit, void *arg) const
    {
      Py_VISIT(callback.ptr());
      for (const auto &[handle, function] : motions)
        Py_VISIT(function.ptr());
      for (const KeptTerm &term : terms)
        Py_VISIT(term.function.ptr());
      return 0;
    }

    /// Drop all functions, for a problem that nobody will use any more.
    void
    forget()
    {
      callback = pybind11::none();
      for (auto &[handle, function] : motions)
        function = pybind11::none();
      for (KeptTerm &term : terms)
        term.function = pybind11::none();
    }
  };
} // namespace Exemplar::Python

#endif
