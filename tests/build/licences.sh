# Each file has a licence whose text is here (REUSE), and CITATION.cff is what its schema allows.
cd "$SRC"
git rev-parse --git-dir > /dev/null 2>&1 || { echo "not a clone"; exit 77; }
command -v reuse > /dev/null || { echo "no reuse"; exit 77; }
reuse lint --quiet || reuse lint
! command -v cffconvert > /dev/null || cffconvert --validate > /dev/null 2>&1 || echo "CITATION.cff: see cffconvert --validate"
# What cites the library names the version that it has.
grep -qx "version: $(sed -n 's/^.define SS_VERSION "\(.*\)"/\1/p' include/stickslip/status.h)" CITATION.cff ||
    echo "CITATION.cff has another version"
