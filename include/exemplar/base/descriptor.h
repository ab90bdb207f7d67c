// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_descriptor_h
#define exemplar_descriptor_h

#include <unistd.h>

namespace Exemplar
{
  /// A file descriptor from open() or the like, closed by the destructor. Negative: none.
  class Descriptor
  {
  public:
    explicit Descriptor(const long number) : number(static_cast<int>(number)) {}

    Descriptor(const Descriptor &) = delete;
    Descriptor &
    operator=(const Descriptor &)
        = delete;

    ~Descriptor()
    {
      if (number >= 0)
        close(number);
    }

    const int number;
  };
} // namespace Exemplar

#endif
