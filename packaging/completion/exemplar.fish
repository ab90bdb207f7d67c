# SPDX-License-Identifier: GPL-3.0-or-later
# What fish offers after "exemplar": commands and options as the program's --help lists them, and files.
function __exemplar_commands
    exemplar --help 2>/dev/null | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\)  *\(.*\)/\1\t\2/p'
end

function __exemplar_options
    set -l words (commandline -opc)
    set -l command (string split -f 1 \t (__exemplar_commands))
    if set -q words[2]; and contains -- $words[2] $command
        exemplar $words[2] --help 2>/dev/null
    else
        exemplar --help 2>/dev/null
    end | sed -n 's/^  \(-h,\)\?\(--[a-z-]*\).*/\2/p'
end

complete -c exemplar -n 'test (count (commandline -opc)) -eq 1' -a '(__exemplar_commands)'
complete -c exemplar -n 'string match -q -- "-*" (commandline -ct)' -a '(__exemplar_options)'
