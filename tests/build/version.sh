# make version leaves the version of before nowhere, but in the comparison with an older library, and where it is history:
# in changelogs and as the version that first had a symbol.
git -C "$SRC" rev-parse --git-dir > /dev/null 2>&1 || { echo "not a clone"; exit 77; }
(cd "$SRC" && git ls-files -z | tar c --null -T -) | tar x
before=$(sed -n 's/^.define SS_VERSION "\(.*\)"/\1/p' include/stickslip/status.h)
env -i PATH="$PATH" "$MAKE" -s version NEW=98.7.6
grep -rIlF "$before" . | grep -v -e '^./tests/long/abi.sh$' -e '[.]symbols$' -e 'changelog$' -e '^./CHANGELOG.md$' || :
grep -cF 98.7.6 include/stickslip/status.h CITATION.cff tools/packaging/package.py
# the newest section of the changelog is this version's
head -n 3 CHANGELOG.md | grep -cF "$before"
