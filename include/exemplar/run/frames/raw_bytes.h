// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_raw_bytes_h
#define exemplar_raw_bytes_h

#include <boost/endian/conversion.hpp>

#include <cstdint>
#include <cstring>
#include <string>

namespace Exemplar
{
  /// Order of the bytes of a number in a file.
  enum class ByteOrder
  {
    little,
    big
  };

  /// Append a number of 1, 2, 4 or 8 bytes.
  template <ByteOrder order, typename Number>
  void
  append_raw(std::string &bytes, const Number number)
  {
    using Bits = std::conditional_t<
        sizeof(Number) == 8, std::uint64_t,
        std::conditional_t<sizeof(Number) == 4, std::uint32_t,
                           std::conditional_t<sizeof(Number) == 2, std::uint16_t, std::uint8_t>>>;
    static_assert(sizeof(Bits) == sizeof(Number));
    Bits bits;
    std::memcpy(&bits, &number, sizeof(Number));
    bits = order == ByteOrder::little ? boost::endian::native_to_little(bits)
                                      : boost::endian::native_to_big(bits);
    bytes.append(reinterpret_cast<const char *>(&bits), sizeof(Number));
  }
} // namespace Exemplar

#endif
