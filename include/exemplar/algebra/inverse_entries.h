// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_inverse_entries_h
#define exemplar_inverse_entries_h

#include <cstddef>

namespace Exemplar
{
  /// Single entries of an inverse that is kept, between unknowns that are named one by one.
  class InverseEntries
  {
  public:
    virtual ~InverseEntries() = default;

    /// Make an unknown known; returns its number, one more than the last. An unknown that is named again gets another
    /// number.
    virtual std::size_t
    add(unsigned int unknown)
        = 0;

    /// The entry of the inverse in the row and the column of two unknowns with these numbers.
    virtual double
    entry(std::size_t row, std::size_t column) const = 0;

    /// Memory in bytes.
    virtual std::size_t
    memory_consumption() const = 0;
  };
} // namespace Exemplar

#endif
