#!/usr/bin/env bash
# Builds everything and runs every test: the release build on whatever GL there is, the CPU side
# again under ASan and UBSan, its threads under TSan, with clang, the frame graph on its own, the
# installed package, the linters.
# Ends with "N passed, N failed". A skipped test is a failed one.
#
#     ./test.sh            everything
#     ./test.sh NAME...    only these steps: build sanitize tsan clang alone install format tidy
#                          cppcheck
set -u
cd "$(dirname "$0")"
.ci/setup test || exit 1

passed=0 failed=0
steps="${*:-build sanitize tsan clang alone install format tidy cppcheck}"
jobs=$(nproc)

report() { # name status
    if [ "$2" = 0 ]; then passed=$((passed + 1)); else failed=$((failed + 1)); fi
    [ "$2" = 0 ] && echo "ok    $1" || echo "FAIL  $1"
}

step() { # name command... : one check
    local name=$1 log
    shift
    log=$(mktemp)
    "$@" >"$log" 2>&1
    local status=$?
    [ "$status" = 0 ] || tail -n 60 "$log"
    rm -f "$log"
    report "$name" "$status"
    return "$status"
}

configure() { # dir options...
    local dir=$1
    shift
    if [ -f "$dir/build.ninja" ]; then
        meson configure "$dir" "$@"
    else
        meson setup "$dir" "$@"
    fi
}

build_in() { # dir options...
    configure "$@" && ninja -C "$1"
}

meson_tests() { # dir label options... : every meson test is one check
    local dir=$1 label=$2 name result
    shift 2
    rm -f "$dir/meson-logs/testlog.json"
    meson test -C "$dir" --no-rebuild --print-errorlogs "$@"
    if [ ! -s "$dir/meson-logs/testlog.json" ]; then
        report "$label: no test ran" 1
        return
    fi
    while read -r result name; do
        [ "$result" = OK ]
        report "$label: $name" $?
    done < <(python3 -c '
import json, sys
for line in open(sys.argv[1]):
    test = json.loads(line)
    print(test["result"], test["name"])' "$dir/meson-logs/testlog.json")
}

wanted() { [[ " $steps " == *" $1 "* ]]; }

sources() { git ls-files '*.c' '*.h' '*.cpp' 2>/dev/null || find framegraph passes plugins samples tests -name '*.[ch]' -o -name '*.cpp'; }

# What runs on a thread beside the frame. Embree and TBB have no instrumentation: what they do among
# themselves is not seen.
threads_build() {
    configure build-tsan -Dwerror=true -Dsamples=false -Db_sanitize=thread -Db_lundef=false &&
        ninja -C build-tsan tests/unit/test_iir_worker
}

clang_build() {
    CC=clang CXX=clang++ build_in build-clang -Dwerror=true
}

alone() { # the frame graph with nothing but libepoxy and EGL
    build_in build-alone -Dpasses=false -Dwerror=true
}

tidy() { # samples/out_of_tree is checked where it is built: by tests/install/outside.sh
    sources | grep '\.c$' | grep -v -e '^tests/fuzz' -e '^samples/out_of_tree' |
        xargs -P "$jobs" -n 1 clang-tidy -p build --quiet 2>/dev/null
}

if wanted build && step "build" build_in build -Dwerror=true -Dpkgconfig.relocatable=true; then
    meson_tests build test
fi
if wanted sanitize && step "build with sanitizers" build_in build-sanitize -Dwerror=true \
    -Db_sanitize=address,undefined -Db_lundef=false; then
    export ASAN_OPTIONS=detect_leaks=1:allocator_may_return_null=1
    export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1
    meson_tests build-sanitize sanitized --suite graph --suite unit --suite numerics \
        --timeout-multiplier 4
    unset ASAN_OPTIONS UBSAN_OPTIONS
fi
if wanted tsan && step "build with ThreadSanitizer" threads_build; then
    export TSAN_OPTIONS=halt_on_error=1
    meson_tests build-tsan threads iir_worker --timeout-multiplier 4
    unset TSAN_OPTIONS
fi
wanted clang && step "build with clang" clang_build
wanted alone && step "the frame graph alone" alone && meson_tests build-alone alone
wanted install && step "a host and plugins against the installed package" tests/install/outside.sh build
wanted format && step "clang-format" sh -c "git ls-files '*.c' '*.h' '*.cpp' | xargs clang-format --dry-run --Werror"
wanted tidy && step "clang-tidy" tidy
wanted cppcheck && step "cppcheck" sh -c "git ls-files 'framegraph/*.c' 'passes/*.c' 'plugins/*.c' 'samples/*.c' |
    cppcheck -j $jobs --quiet --std=c11 --enable=warning,portability --inline-suppr --error-exitcode=1 \
        --suppressions-list=.ci/cppcheck.txt --file-list=- -I framegraph/include -I passes/include \
        -I plugins/include -I samples/afterglow -I samples/scenes -I ."

echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
