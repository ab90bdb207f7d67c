// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_exchange_h
#define exemplar_exchange_h

namespace Exemplar
{
  /// What processes that share a body tell each other. Loops over cells and nodes see the part
  /// of their own process; what concerns the whole body goes through here. This base is that of
  /// one process, which has nobody to talk to.
  class Exchange
  {
  public:
    virtual ~Exchange() = default;

    /// The sum of the numbers that the processes give; the same on all of them, bit for bit.
    virtual double
    sum(const double own) const
    {
      return own;
    }

    /// The greatest of the numbers that the processes give; a NaN is the greatest of all.
    virtual double
    max(const double own) const
    {
      return own;
    }

    /// The exchange of one process.
    static const Exchange &
    serial()
    {
      static const Exchange exchange;
      return exchange;
    }
  };
} // namespace Exemplar

#endif
