# make site: the index leads to every page of the manual and to pictures, and no link within the site leads nowhere.
command -v mandoc > /dev/null || { echo "no mandoc"; exit 77; }
top=$PWD
(cd "$SRC" && OUT=$top/site VERSION=1.2.3 sh tools/site.sh man/*.[1-9])
cd site
for page in "$SRC"/man/*.[1-9]; do
    grep -qF "href=\"${page##*/}.html\"" index.html || echo "not in the index: ${page##*/}"
done
[ "$(grep -c '<figure>' index.html)" -ge 10 ] || echo "hardly any picture"
for page in *.html; do
    grep -o '\(href\|src\)="[^"]*"' "$page" | sed 's/^[^"]*"//; s/"$//' | sort -u | while read -r link; do
        file=${link%%#*} mark=${link#"${link%%#*}"}
        case $link in http*://*) continue ;; esac
        [ -s "${file:-$page}" ] || echo "$page: no file $link"
        [ -z "$mark" ] || grep -qF "id=\"${mark#\#}\"" "${file:-$page}" || echo "$page: no place $link"
    done
done
# A page of the library's own is not sought elsewhere.
! grep -ho 'href="https://manpages[^"]*"' ./*.html | grep -E '/(ss-|stickslip)' || true
grep -q 'stickslip-features.7.html' ss-features.1.html || echo "pages are not linked"
