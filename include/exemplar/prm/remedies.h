// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_remedies_h
#define exemplar_remedies_h

#include <functional>
#include <string>
#include <vector>

namespace Exemplar
{
  struct DeclaredKey;

  /// The letters and digits of a text in lower case: YoungsModulus and youngs_modulus agree.
  std::string
  letters_of(const std::string &text);

  /// Remedy for an undeclared path ("Section/Key"): the keys that may be meant, or else the keys of
  /// the section, in sentences. Keys of the command line are followed by `option_value` ("=value"),
  /// as in a shell.
  std::string
  remedy_of_key(const std::string              &path,
                const std::vector<DeclaredKey> &keys,
                const std::string              &option_value = "");

  /// Remedy for a value that a key does not allow, beginning with a blank; may be empty. If undoing
  /// a common mistake, such as a decimal comma, makes it allowed, this is the remedy; else the
  /// meaning of the key. `is_allowed` tests texts.
  std::string
  remedy_of_value(const DeclaredKey                              &key,
                  const std::string                              &value,
                  const std::function<bool(const std::string &)> &is_allowed);
} // namespace Exemplar

#endif
