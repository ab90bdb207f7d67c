// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_remedies_h
#define exemplar_remedies_h

#include <functional>
#include <string>
#include <vector>

namespace Exemplar
{
  struct DeclaredKey;

  /// The letters and digits of a text: people write YoungsModulus, youngs_modulus and the like.
  std::string
  letters_of(const std::string &text);

  /// What to say of a path ("Section/Key") that no key has: which keys may have been meant, or
  /// else which keys the section has. One or more sentences. Keys of the command line are named
  /// with `option_value` ("=value") behind them, as a shell takes them.
  std::string
  remedy_of_key(const std::string              &path,
                const std::vector<DeclaredKey> &keys,
                const std::string              &option_value = "");

  /// What to say of a value that a key does not allow. If it becomes an allowed one by a change
  /// that undoes a common mistake, such as a decimal comma: that change, and what it makes. Else
  /// what the key means. Begins with a blank, or is empty. `is_allowed` tells of a
  /// text whether the key allows it.
  std::string
  remedy_of_value(const DeclaredKey                              &key,
                  const std::string                              &value,
                  const std::function<bool(const std::string &)> &is_allowed);
} // namespace Exemplar

#endif
