// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cerrno>
#include <cstddef>

// Memory that is asked for is counted where it is: glibc lets a program have its own malloc(), which all else calls.

#if defined(__GLIBC__) && defined(NDEBUG) && !defined(__SANITIZE_ADDRESS__)
#define exemplar_counts_allocations

namespace
{
  std::atomic<unsigned long> n_allocations(0);
}

extern "C"
{
  void *
  __libc_malloc(std::size_t size);
  void *
  __libc_calloc(std::size_t n, std::size_t size);
  void *
  __libc_realloc(void *memory, std::size_t size);
  void *
  __libc_memalign(std::size_t alignment, std::size_t size);

  void *
  malloc(std::size_t size) noexcept
  {
    ++n_allocations;
    return __libc_malloc(size);
  }

  void *
  calloc(std::size_t n, std::size_t size) noexcept
  {
    ++n_allocations;
    return __libc_calloc(n, size);
  }

  void *
  realloc(void *memory, std::size_t size) noexcept
  {
    ++n_allocations;
    return __libc_realloc(memory, size);
  }

  void *
  aligned_alloc(std::size_t alignment, std::size_t size) noexcept
  {
    ++n_allocations;
    return __libc_memalign(alignment, size);
  }

  int
  posix_memalign(void **memory, std::size_t alignment, std::size_t size) noexcept
  {
    ++n_allocations;
    *memory = __libc_memalign(alignment, size);
    return *memory == nullptr ? ENOMEM : 0;
  }
}
#endif

#ifdef exemplar_counts_allocations
namespace Exemplar::Testing
{
  namespace
  {
    /// How often the tenth step of a scene asks for memory, beyond the report's history, which grows by doubling, and
    /// two vectors in each solve with the factor.
    long
    n_in_tenth_step(const std::vector<std::string> &overrides)
    {
      Scene scene("set Scene = dynamic\n" + bar
                      + "subsection Handles\n set Names = left\n subsection left\n set Select = "
                        "boundary 1\n"
                        "set Motion = 0; 0; 0.2*sin(3*t)\n end\nend\n"
                        "subsection Loads\n set Gravity = 0, 0, -1\nend\n"
                        "subsection Time\n set Step = 0.01\n set End = 1\nend\n",
                  overrides);
      for (unsigned int step = 1; step < 10; ++step)
        EXPECT_TRUE(is_success(scene.problem.advance().status));
      const unsigned long before = n_allocations;
      const SolveReport   report = scene.problem.advance();
      const auto          n      = static_cast<long>(n_allocations - before);
      EXPECT_EQ(report.factorizations, 0u); // a new factor needs new memory
      EXPECT_GT(report.iterations, 0u);
      EXPECT_GT(n, 0); // the history: it is counted
      long n_of_history = 0;
      for (std::size_t capacity = 0; capacity < report.residual_history.size();
           capacity             = std::max<std::size_t>(1, 2 * capacity))
        ++n_of_history;
      return n - n_of_history - 2 * static_cast<long>(report.iterations);
    }

    TEST(Allocations, NoneInTheStepsOfQuasiNewton)
    {
      EXPECT_LE(n_in_tenth_step({}), 0);
      EXPECT_LE(n_in_tenth_step({ "Model/Dilatation=cells" }), 0);
      EXPECT_LE(n_in_tenth_step({ "Time/Scheme=bdf2" }), 0);
      EXPECT_LE(n_in_tenth_step({ "Model/Element=P2" }), 0);
    }
  } // namespace
} // namespace Exemplar::Testing
#endif
