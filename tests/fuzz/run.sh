#!/usr/bin/env bash
# Fuzzes the readers of OBJ, MTL and scene files.
#
#   tests/fuzz/run.sh [SECONDS [obj|mtl|config]...]
#
# Without SECONDS, as a test: for LIMN_FUZZ_SECONDS each, or not at all (77) where that is not set or clang is
# missing. Begins with the files of LIMN_TEST_DATA and our own scenes; keeps what it finds interesting in
# build/fuzz/corpus_*.
set -euo pipefail
cd "$(dirname "$0")/../.."
seconds=${1:-${LIMN_FUZZ_SECONDS:-}}
[ $# = 0 ] || shift
if ! command -v clang++ >/dev/null || [ -z "$seconds" ]; then
    echo "not fuzzed: say for how many seconds, and have clang installed"
    exit 77
fi
targets=("$@")
[ ${#targets[@]} -gt 0 ] || targets=(obj mtl config)
mkdir -p build/fuzz
if ! { cmake --preset fuzz && cmake --build --preset fuzz --target "${targets[@]/#/fuzz_}"; } >build/fuzz/build.log 2>&1
then
    tail -n 40 build/fuzz/build.log
    exit 1
fi
for target in "${targets[@]}"; do
    corpus=build/fuzz/corpus_$target
    mkdir -p "$corpus"
    case $target in obj) pattern='*.obj' ;; mtl) pattern='*.mtl' ;; *) pattern='*.toml' ;; esac
    find scenes render_configs ${LIMN_TEST_DATA:+"$LIMN_TEST_DATA"} -name "$pattern" -size -20k -print0 | while IFS= \
        read -r -d '' file; do cp -n "$file" "$corpus/$(echo "$file" | md5sum | cut -c1-16)"; done
    echo "fuzzing $target for $seconds s"
    # The log is kept: a pipe would hide the exit code.
    build/fuzz/fuzz_"$target" -max_total_time="$seconds" -max_len=20000 -timeout=60 -rss_limit_mb=4096 \
        -print_final_stats=1 -verbosity=0 -artifact_prefix=build/fuzz/ "$corpus" >build/fuzz/"$target".log 2>&1 && \
        failed=0 || failed=1
    grep -E 'stat::|ERROR|SUMMARY|Test unit|Base64' build/fuzz/"$target".log || true
    [ "$failed" = 0 ] || exit 1
done
