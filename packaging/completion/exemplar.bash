# SPDX-License-Identifier: GPL-3.0-or-later
# What bash offers after "exemplar": commands and options as the program's --help lists them, and files.
_exemplar()
{
  local program=${COMP_WORDS[0]} word=${COMP_WORDS[COMP_CWORD]} help commands
  help=$("$program" --help 2>/dev/null)
  commands=$(sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p' <<<"$help")
  if [ "$COMP_CWORD" -gt 1 ] && grep -qxF -- "${COMP_WORDS[1]}" <<<"$commands"; then
    help=$("$program" "${COMP_WORDS[1]}" --help 2>/dev/null)
    commands=
  fi
  [ "$COMP_CWORD" -eq 1 ] || commands=
  COMPREPLY=($(compgen -W "$commands $(sed -n 's/^  \(-h,\)\?\(--[a-z-]*\).*/\2/p' <<<"$help")" -- "$word"))
}
complete -o bashdefault -o default -F _exemplar exemplar
