// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_prm_tools_h
#define exemplar_prm_tools_h

#include <exemplar/base/errors.h>

#include <deal.II/base/parameter_handler.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace Exemplar
{
  /// A key that is declared nowhere, as opposed to a value that is not allowed.
  class UnknownKey : public UserError
  {
    using UserError::UserError;
  };

  /// One table per enum gives its names in scene files, the pattern and the text.
  template <typename Enum>
  using EnumTable = std::vector<std::pair<Enum, std::string>>;

  template <typename Enum>
  std::string
  enum_name(const Enum value, const EnumTable<Enum> &table)
  {
    for (const auto &[entry, name] : table)
      if (entry == value)
        return name;
    throw std::logic_error("enum value without a name");
  }

  /// Declare `key` as a choice among the table's names, bound to `value`, whose
  /// present content is the default.
  template <typename Enum>
  void
  declare_enum(dealii::ParameterHandler &prm,
               const std::string        &key,
               Enum                     &value,
               const EnumTable<Enum>    &table,
               const std::string        &documentation)
  {
    std::string names;
    for (const auto &entry : table)
      names += (names.empty() ? "" : "|") + entry.second;
    prm.declare_entry(key, enum_name(value, table), dealii::Patterns::Selection(names),
                      documentation);
    prm.add_action(key,
                   [&value, &table](const std::string &text)
                   {
                     for (const auto &[entry, name] : table)
                       if (name == text)
                         value = entry;
                   });
  }

  /// Declare the name of an input file; relative to the .prm that sets it.
  void
  declare_input_file(dealii::ParameterHandler &prm,
                     const std::string        &key,
                     std::string              &value,
                     const std::string        &documentation);

  /// The same for a list of files, separated by commas.
  void
  declare_input_files(dealii::ParameterHandler &prm,
                      const std::string        &key,
                      std::vector<std::string> &values,
                      const std::string        &documentation);

  /// The text without blanks at its ends.
  std::string
  trim(const std::string &text);

  /// Values separated by a sign, such as expressions by ';', without the blanks around them.
  std::vector<std::string>
  split_trimmed(const std::string &text, char separator);

  /// "set KEY = VALUE" at its place in a file, or a --set of the command line.
  struct Assignment
  {
    std::vector<std::string> subsections;
    std::string              key;
    std::string              value;
    std::string              place; ///< "scene.prm:12" or "--set"

    /// "Section/Key", as --set and messages write it.
    std::string
    path() const;
  };

  /// The bytes of a .prm file. Throws UserError if it cannot be read.
  std::string
  read_prm(const std::filesystem::path &file);

  /// All assignments in the text of a .prm file in order, checked for syntax only: `subsection`
  /// and `end` match, no key is set twice. Throws UserError with file and line.
  std::vector<Assignment>
  read_assignments(const std::string &prm_text, const std::string &file);

  /// "Section/Subsection/Key=value"; `place` is the assignment's.
  Assignment
  parse_assignment(const std::string &text, const std::string &place);

  /// The same from a --set of the command line.
  Assignment
  parse_override(const std::string &text);

  /// The value that `path` ("Section/Key") gets last, or nullptr.
  const Assignment *
  find_assignment(const std::vector<Assignment> &assignments, const std::string &path);

  /// A declared parameter, for checks and for the reference.
  struct DeclaredKey
  {
    std::vector<std::string> subsections;
    std::string              key;
    std::string              value;
    std::string              default_value;
    std::string              documentation;
    std::string              allowed; ///< in words
    bool                     is_input_file;
    bool                     is_list; ///< values separated by commas

    std::string
    path() const;
  };

  /// Everything declared in `prm`, in order of declaration.
  std::vector<DeclaredKey>
  declared_keys(const dealii::ParameterHandler &prm);

  /// Set the values in `prm`; input files become absolute, relative ones starting
  /// from `directory`; if that is empty, they stay. Throws UnknownKey for an undeclared key (with the nearest
  /// declared one) and UserError for a value that its pattern does not allow.
  void
  apply_assignments(dealii::ParameterHandler      &prm,
                    const std::vector<Assignment> &assignments,
                    const std::filesystem::path   &directory);

  /// All keys and values in force as a .prm; with documentation, default and
  /// allowed values as comments where `documented`.
  void
  print_keys(std::ostream &out, const std::vector<DeclaredKey> &keys, bool documented);
} // namespace Exemplar

#endif
