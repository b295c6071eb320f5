# Sourced by run and nightly: finds Pythons, runs steps of the Makefile, and prints a table of their seconds.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# Prints a Python of a version, as a path. One on PATH may be a shim that only says what it cannot find.
python_of() {
  local candidate
  for candidate in "python$1" "${PYENV_ROOT:-$HOME/.pyenv}/versions/$1".*/bin/python python3; do
    "$candidate" -c "import sys, venv; sys.exit('%d.%d' % sys.version_info[:2] != '$1'); " >/dev/null 2>&1 &&
      "$candidate" -c 'import sys; print(sys.executable)' && return
  done
  return 1
}

here=() absent=()
for version in $(sed -n 's/.*"Programming Language :: Python :: \(3\.[0-9]*\)".*/\1/p' pyproject.toml | sort -V); do
  if python_of "$version" >/dev/null; then here+=("$version"); else absent+=("$version"); fi
done
test ${#here[@]} -gt 0 || { echo "none of the Pythons that pyproject.toml names is here: ${absent[*]}"; exit 1; }
oldest=${here[0]} newest=${here[-1]}

# Pages are tested in a real browser where there is one; without it, these tests are skipped and say so.
command -v chromium >/dev/null || { apt-get update && apt-get install -y --no-install-recommends chromium; } >/dev/null 2>&1 ||
  echo "not tested here: pages in a browser, since Chromium cannot be installed"

said=$(mktemp) steps=()
finish() {
  local code=$?
  printf '\n%8s  %s\n' seconds step
  for each in ${steps[@]+"${steps[@]}"}; do printf '%8s  %s\n' "${each%% *}" "${each#* }"; done
  printf '%8s  all\n' "$SECONDS"
  grep "^not tested here: " "$said" || true
  for version in ${absent[@]+"${absent[@]}"}; do echo "not tested here: Python $version"; done
  rm -f "$said"
  test "$code" = 0 || echo "failed: the last step of the table"
}
trap finish EXIT

# step VERSION MAKE-WORDS...: one step with a Python, in an environment of its own.
step() {
  local version=$1 began=$SECONDS ended=0
  shift
  echo "== Python $version: make $*"
  make "$@" PYTHON="$(python_of "$version")" VENV=".venv-$version" 2>&1 | tee -a "$said" || ended=1
  steps+=("$((SECONDS - began)) Python $version: make $*")
  return $ended
}
