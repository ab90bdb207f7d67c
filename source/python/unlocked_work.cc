// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/python/unlocked_work.h>

#include <chrono>
#include <thread>

namespace Exemplar::Python
{
  namespace py = pybind11;

  UnlockedWork::UnlockedWork()
  {
    ++n_running;
    unlocked.emplace();
  }

  UnlockedWork::~UnlockedWork()
  {
    unlocked.reset();
    --n_running;
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
