// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/python/kept_functions.h>

namespace Exemplar::Python
{
  int
  KeptFunctions::visit(const visitproc visit, void *arg) const
  {
    Py_VISIT(callback.ptr());
    for (const auto &[handle, function] : motions)
      Py_VISIT(function.ptr());
    for (const KeptTerm &term : terms)
      Py_VISIT(term.function.ptr());
    return 0;
  }

  void
  KeptFunctions::forget()
  {
    callback = pybind11::none();
    for (auto &[handle, function] : motions)
      function = pybind11::none();
    for (KeptTerm &term : terms)
      term.function = pybind11::none();
  }
} // namespace Exemplar::Python
