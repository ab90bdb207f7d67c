// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_shared_value_h
#define exemplar_shared_value_h

#include <sys/mman.h>

#include <atomic>
#include <new>

namespace Exemplar
{
  /// A value in memory shared by this process and copies that are made of it later
  /// (in_process_copy()).
  template <typename T>
  class SharedValue
  {
  public:
    /// Throws std::bad_alloc if there is no shared memory.
    explicit SharedValue(const T value)
    {
      static_assert(std::atomic<T>::is_always_lock_free);
      void *const page = mmap(nullptr, sizeof(std::atomic<T>), PROT_READ | PROT_WRITE,
                              MAP_SHARED | MAP_ANONYMOUS, -1, 0);
      if (page == MAP_FAILED)
        throw std::bad_alloc();
      place = new (page) std::atomic<T>(value);
    }

    SharedValue(const SharedValue &) = delete;
    SharedValue &
    operator=(const SharedValue &)
        = delete;

    ~SharedValue()
    {
      munmap(place, sizeof(std::atomic<T>));
    }

    void
    store(const T value)
    {
      place->store(value);
    }

    T
    load() const
    {
      return place->load();
    }

  private:
    std::atomic<T> *place;
  };
} // namespace Exemplar

#endif
