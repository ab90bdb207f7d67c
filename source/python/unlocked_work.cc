// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/environment.h>
#include <exemplar/python/unlocked_work.h>

#include <chrono>
#include <thread>

namespace Exemplar::Python
{
  namespace py = pybind11;

  UnlockedWork::UnlockedWork()
  {
    if (n_running++ == 0)
      blas_threads_before = set_blas_threads(1);
    unlocked.emplace();
  }

  UnlockedWork::~UnlockedWork()
  {
    unlocked.reset();
    if (--n_running == 0)
      set_blas_threads(blas_threads_before);
  }

  void
  UnlockedWork::check()
  {
    if (!is_ending)
      return;
    PyErr_SetNone(PyExc_SystemExit);
    throw py::error_already_set();
  }

  void
  UnlockedWork::end_all()
  {
    is_ending = true;
    while (n_running > 0)
    {
      const py::gil_scoped_release unlocked;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
} // namespace Exemplar::Python
