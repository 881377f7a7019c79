# shellcheck shell=sh
# SPDX-License-Identifier: MIT
# For scripts to source: what goes well says little, what fails says why.

say() { echo "$*" >&2; }

# Shows what a command printed only if it failed, without ninja's lines of progress.
quietly() {
  quiet_log=$(mktemp)
  if "$@" >"$quiet_log" 2>&1 </dev/null; then
    rm "$quiet_log"
  else
    grep -v '^\[[0-9]*/[0-9]*\] ' "$quiet_log" >&2
    rm "$quiet_log"
    exit 1
  fi
}

# Runs the tests that were built in a folder; shows those that failed and the summary. Words after the folder
# start ctest, as `setarch -R` does.
run_tests() {
  tests=$1
  shift
  if "$@" ctest --test-dir "$tests" --output-on-failure --no-tests=error --timeout 600 >"$tests/ctest.log" 2>&1 </dev/null; then
    sed -n '/tests passed,/,$p' "$tests/ctest.log"
    # A program may hold many of them.
    sed -n 's/^\[  PASSED  \] \([0-9]*\) test.*/\1/p' "$tests/Testing/Temporary/LastTest.log" |
      awk '{ n += $1 } END { print n " tests passed in " NR " programs" }'
  else
    grep -v -e ' Passed ' -e '^ *Start ' "$tests/ctest.log"
    exit 1
  fi
}
