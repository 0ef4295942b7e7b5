# Completion of poreshock for bash: commands, options, scenes, and the keys of --set.
_poreshock() {
  local program=${COMP_WORDS[0]} word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]}
  local commands="run check sample analyze compare info materials keys"
  if [[ $COMP_CWORD == 1 ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$commands --help --version" -- "$word")
  elif [[ $word == -* ]]; then
    local options
    options=$("$program" "${COMP_WORDS[1]}" --help 2>/dev/null | grep -o -- '--[a-z-]*' | sort -u)
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word")
  elif [[ $before == --set ]]; then
    # Keys by their tables, the first of repeated ones: material.0.yield=
    local keys
    keys=$("$program" keys 2>/dev/null | awk -F'`' '
      /^(#+ )?At the top/ { table = "" }
      /^(#+ )?`\[/ { table = $2; repeated = table ~ /^\[\[/; gsub(/[][]/, "", table);
               sub(/^(material|body|void|probe|sample\.mixture)/, "&.0", table); table = table "." }
      /^\| `/ { print table $2 "=" }')
    compopt -o nospace
    mapfile -t COMPREPLY < <(compgen -W "$keys" -- "$word")
  elif [[ ${COMP_WORDS[1]} == materials ]]; then
    local names
    names=$("$program" materials 2>/dev/null | grep -o '^[a-z0-9_]*$')
    mapfile -t COMPREPLY < <(compgen -W "$names" -- "$word")
  else
    compopt -o filenames
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
  fi
}
complete -F _poreshock poreshock
