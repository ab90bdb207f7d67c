// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_kept_functions_h
#define exemplar_kept_functions_h

#include <pybind11/pybind11.h>

#include <list>
#include <map>
#include <string>

namespace Exemplar::Python
{
  /// The function of a term of one's own.
  struct KeptTerm
  {
    pybind11::object function;
    bool             is_checked = false; ///< its gradient, where it acts
  };

  /// The functions of Python that a problem calls. They keep their places.
  struct KeptFunctions
  {
    std::map<std::string, pybind11::object> motions; ///< by handle
    std::list<KeptTerm>                     terms;
    pybind11::object                        callback = pybind11::none(); ///< of on_iteration()

    /// For Python's garbage collector: call visit(function, arg) for all.
    int
    visit(visitproc visit, void *arg) const;

    /// For a problem that nobody will use any more.
    void
    forget();
  };
} // namespace Exemplar::Python

#endif
