#!/bin/sh
# ss-report -- a page for each recording, with pictures, and a table of all: HTML for any browser.
#
# The tools do the work; here their text becomes HTML, in which nothing of a file is markup.  All is
# written into a folder beside DIR, which gets its name when it is whole.
set -u
export LC_ALL=C
version=@VERSION@

usage() {
    cat <<'END'
usage: ss-report [options] -o DIR FILE ...
Write into a new folder DIR, for each recording, an HTML page with its signal,
contours, features, and the commands that make them; and index.html, the table
of all.  The same files give the same bytes.
  -c, --column=NAME|N     column to analyse (a, or the only one)
      --threshold=DB, --norm=l2|l1, --fmin=HZ, --mass=KG, --stiffness=N/m,
      --displacement=NAME|N, --force=NAME|N, --drop=HEIGHT
                          as in ss-features
      --decay             what ss-backbone finds of free decays, too
Of reading, as in ss-cat:
      --time=NAME|N, --time-unit=UNIT, --rate=HZ, --table=N, --gaps=HOW,
      --resample=HZ, --from=S, --to=S, --scale=[NAME=]F, --unit=[NAME=]U
  -j, --jobs=N            look for features in N files at a time (1)
  -o, --output=DIR        the folder to be made
  -q, --quiet   -v, --verbose   -h, --help   --version
END
}

(: >&2) || exec 2> /dev/null
exec 3>&2
say() { printf 'ss-report: %s\n' "$1" | tr '\001-\011\013-\037\177' '?' >&3; }
die() { say "$2"; exit "$1"; }
quote() { printf "'"; printf %s "$1" | sed "s/'/'\\\\''/g"; printf "'"; }
# Text as HTML shows it, on one line or more.
escape() {
    tr '\001-\010\013-\037\177' '?' | sed 's/&/\&amp;/g; s/</\&lt;/g; s/>/\&gt;/g; s/"/\&quot;/g'
}
escape_line() { printf %s "$1" | tr '\n' '?' | escape; }

begin() {       # TITLE, escaped
    cat <<END
<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'">
<meta name="viewport" content="width=device-width"><title>$1</title>
<style>
@CSS@
</style></head><body>
END
}

# shellcheck disable=SC2016  # of awk
# The rows of a text, whose columns are NAME/UNIT, as cells of HTML: a number with its error, if the next
# column has one; only columns that have something.
cells='BEGIN { FS = "\t" }
    /^# columns:/ { sub(/^# columns: /, ""); gsub(/\(N s\/m\)/, "N~s/m"); n = split($0, column, " ")
        for (c = 1; c <= n; c++) { unit[c] = column[c]; sub(/\/.*/, "", column[c])
            sub(/^[^\/]*\/?/, "", unit[c]); gsub(/[()]/, "", unit[c]); sub(/~/, " ", unit[c])
            is_error[c] = column[c] ~ /_error$/ } next }
    !/^#/ { rows++; for (c = 1; c <= n; c++) {
        cell[rows, c] = $c; if ($c != "-" && !is_error[c]) used[c] = 1 } }
    function name(c,   text) { text = column[c]; gsub(/_/, " ", text); return text }
    function head(c) { return "<th>" name(c) "<br><span class=\"unit\">" unit[c] "</span></th>" }
    function known(x, form) { return x == "-" ? "&ndash;" : sprintf(form, x) }
    function rounded(x, e,   d) { if (x == "-" || e == "-" || e + 0 == 0) return known(x, "%.6g")
        d = log(e) / log(10); d = 1 - (d < int(d) ? int(d) - 1 : int(d)); if (d < 0) d = 0
        return d > 9 ? sprintf("%.9g &plusmn; %.2g", x, e) : sprintf("%." d "f &plusmn; %." d "f", x, e) }
    function show(r, c) { return is_error[c + 1] ? rounded(cell[r, c], cell[r, c + 1]) \
        : known(cell[r, c], column[c] ~ /^(onset|end|time)$/ ? "%.9g" : "%.5g") }'

numbers() {     # ROW: those of a recording, one a line
    awk -v r="$1" "$cells"'
        END { if (cell[r, 2] != "-") print "<tr><td>unit of column</td><td>" cell[r, 2] "</td><td></td></tr>"
            for (c = 3; c < n; c += 2) if (cell[r, c] != "-")
                print "<tr><td>" name(c) "</td><td>" show(r, c) "</td><td class=\"text unit\">" unit[c] \
                    "</td></tr>" }' "$work/escaped"
}

events() {
    awk "$cells"'
        END { printf "<thead><tr>"; for (c = 1; c <= n; c++) if (used[c]) printf "%s", head(c)
            print "</tr></thead><tbody>"
            for (r = 1; r <= rows; r++) { printf "<tr>"
                for (c = 1; c <= n; c++) if (used[c]) printf "<td>%s</td>", show(r, c)
                print "</tr>" } print "</tbody>" }' "$1"
}

table() {       # of all recordings, with links to their pages
    awk "$cells"'
        FILENAME ~ /\/pages$/ { page[FNR] = $0; rows = 0; next }
        /^# [a-z_]*: [-0-9][^ ]* / { split($0, word, " "); sub(/:$/, "", word[2])
            for (i = 1; i < 4; i++) note[word[2], i] = word[i + 2] }
        function foot(text, i) { printf "<tr><td>%s</td>", text
            for (c = 3; c < n; c += 2) if (used[c]) printf "<td>%s</td>", known(note[column[c], i], "%.5g")
            print "</tr>" }
        function why(r,   text, place) { text = cell[r, n]; place = cell[r, 1] ": "
            if (index(text, place) == 1) text = substr(text, length(place) + 1)
            return text == "-" ? "" : "<br><span class=\"why\">" text "</span>" }
        END { printf "<thead><tr><th>recording</th>"
            for (c = 3; c < n; c += 2) if (used[c]) printf "%s", head(c)
            print "</tr></thead><tbody>"
            for (r = 1; r <= rows; r++) {
                printf "<tr><td class=\"text\"><a href=\"%s\">%s</a>%s</td>", page[r], cell[r, 1], why(r)
                for (c = 3; c < n; c += 2) if (used[c]) printf "<td>%s</td>", show(r, c)
                print "</tr>" }
            print "</tbody><tfoot>"; foot("mean", 1); foot("standard deviation between files", 2)
            foot("standard error within a file, rms", 3); print "</tfoot>" }' "$work/pages" "$work/escaped"
}

# A picture of gnuplot; two of them on a page must not share names.
inline() {      # NAME
    sed -e 1d -e "/<text>/!s/ id=\(['\"]\)/ id=\1$1-/g" -e "/<text>/!s/href='#/href='#$1-/g" \
        -e "/<text>/!s/url(#/url(#$1-/g" "$work/$1.svg"
}

# Run a tool and note how, without our folder; what it says is a reason, unless it could not write.
run() {
    command=$(for word; do
        printf ' %s' "$(quote "${word#"$work"/}" | sed "s/^'\([A-Za-z0-9_.,:=+/-]*\)'\$/\1/")"
    done)
    commands=$commands${command# }$newline
    "$@" 2> "$work/said" < /dev/null && return
    if ! [ -s "$work/said" ] || grep -q ': write error: \|: No space left on device$' "$work/said"; then
        die 1 "$dir: $1 could not write; is the disk full?"
    fi
    printf '<p class="why">%s</p>\n' "$(sed 1q "$work/said" | escape)"
    return 1
}

decay() {       # FILE
    echo '<h2>Free decay</h2>'
    eval "run ss-backbone -q $options $backbone -o \"\$work/decay.tsv\" -- \"\$1\"" || return
    escape < "$work/decay.tsv" | awk "$cells"'
        /^# (mechanism|decay): / { own = 1 }
        own && /^#/ { n = split($0, word, " ")
            if (word[3] + 0 == word[3] && word[4] + 0 == word[4])
                $0 = "# " word[2] " " rounded(word[3], word[4]) (n > 4 ? " " word[5] : "")
            print "<p>" substr($0, 3) "</p>" }' > "$work/decay.html"
    cat "$work/decay.html"
    printf '<tr><td class="text"><a href="%s">%s</a></td>%s</tr>\n' "$name" "$(escape_line "$1")" \
        "$(awk '{ gsub(/<.?p>/, ""); key = $1; sub(/^[a-z_]*: /, "") } key ~ /^(mechanism|decay):/ { is = $0 }
            key == "frequency:" { f = $0 } key == "damping_ratio:" { z = $0 }
            END { print "<td class=\"text\">" is "</td><td>" f "</td><td>" z "</td>" }' "$work/decay.html")" \
        >> "$work/decays"
    grep -q '^[0-9]' "$work/decay.tsv" || return
    eval "run ss-backbone -q $options $backbone -o \"\$work/decay.svg\" -- \"\$1\"" && inline decay
    printf '<div class="wide"><table>\n%s</table></div>\n' "$(events "$work/decay.tsv")"
}

page() {        # ROW FILE
    commands=''
    begin "$(escape_line "${2##*/}")"
    printf '<p><a href="index.html">All recordings</a></p><h1>%s</h1>\n' "$(escape_line "$2")"
    eval "run ss-features -q $options $finding -o \"\$work/features.tsv\" -- \"\$2\"" ||
        { [ -z "$decays" ] || decay "$2"; foot "$2"; return; }
    column=$(sed -n 's/^# column: //p' "$work/features.tsv")
    printf '<p>Column %s</p>\n<h2>Signal</h2>\n' "$(escape_line "$column")"
    eval "run ss-plot -q $options --column=\"\$column\" --features \"\$work/features.tsv\" \
        -o \"\$work/signal.svg\" -- \"\$2\"" && inline signal
    echo '<h2>Contours of the wavelet coefficients, with what was found</h2>'
    eval "run ss-morlet -q $options --column=\"\$column\" --detrend mean -o \"\$work/run.h5\" -- \"\$2\"" &&
        run ss-contour -q --features "$work/features.tsv" -o "$work/contours.svg" "$work/run.h5" &&
        inline contours &&
        echo '<p>Triangles at the top: jumps and kinks. Bars at the bottom: transitions between stick and slip. Rings:
local maxima. Shaded: the ends of the record (cone of influence).</p>'
    printf '<h2>Numbers, with standard errors</h2>\n<table><tbody>\n%s</tbody></table>\n' "$(numbers "$1")"
    escape < "$work/features.tsv" | sed -n 's/^# about_\([a-z]*\): \(.*\)/<p class="why">\1: \2<\/p>/p
        s/^# \(spikes: .*\)/<p>\1<\/p>/p'
    printf '<h2>Transitions</h2>\n<div class="wide"><table>\n%s</table></div>\n' "$(events "$work/features.tsv")"
    [ -z "$decays" ] || decay "$2"
    foot "$2"
}

foot() {        # FILE
    printf '<h2>How to make it again</h2>\n<pre>'; printf %s "$commands" | escape
    printf '</pre>\n<p>libstickslip %s. Input, by cksum: %s</p>\n</body></html>\n' "$version" \
        "$({ cksum < "$1"; } 2> /dev/null || echo 'not readable')"
}

# One write, so that its failure is seen.
write() { printf '%s\n' "$2" > "$new/$1" || die 1 "$dir/$1: not written"; }

newline='
'
options='' finding='' backbone='' decays='' dir='' jobs='' quiet='' row=0
left=$# file=''                        # arguments to look at; files, between which options may be, go behind them
while [ "$left" -gt 0 ]; do
    case $file$1 in
    --) file=/; shift; left=$((left - 1)); continue ;;
    --*=*) name=${1%%=*} value=${1#*=} takes=1 ;;
    -[cjo]?*) value=${1#-?} name=${1%"$value"} takes=1 ;;
    -?*) name=$1 value=${2-} takes=2 ;;
    *) set -- "$@" "$1"; shift; left=$((left - 1)); continue ;;
    esac
    case $name in
    -h|--help) { usage; } 2> /dev/null || die 1 'write error'; exit ;;
    --version) { echo "ss-report (libstickslip) $version"; } 2> /dev/null || die 1 'write error'; exit ;;
    -[qv]|--quiet|--verbose) quiet=$name takes=1 ;;
    --decay) decays=1 takes=1 ;;
    -o|--output) dir=${value%/} ;;
    -j|--jobs) jobs="--jobs=$(quote "$value")" ;;
    -c|--column|--mass)
        [ "$name" != -c ] || name=--column
        finding="$finding $name=$(quote "$value")" backbone="$backbone $name=$(quote "$value")" ;;
    --time|--time-unit|--rate|--table|--gaps|--resample|--from|--to|--scale|--unit)
        options="$options $name=$(quote "$value")" ;;
    --threshold|--norm|--fmin|--stiffness|--displacement|--force|--drop)
        finding="$finding $name=$(quote "$value")" ;;
    *) die 2 "unrecognized option '$name'" ;;
    esac
    [ "$left" -ge "$takes" ] || die 2 "option '$name' requires an argument"
    shift "$takes"; left=$((left - takes))
done
[ -n "$dir" ] || die 2 "-o DIR is needed, a folder to be made"
[ $# -gt 0 ] || die 2 "no recordings; name files"
# Neither an option nor, to awk, an assignment.
case $dir in -*|[!/]*=*) dir=./$dir ;; esac
refuse_dir() { die 1 "$dir: is there already; remove it, or name another folder"; }
if [ -e "$dir" ] || [ -L "$dir" ]; then refuse_dir; fi

# A file of results, ours, which a pattern such as *.csv names beside recordings.
is_table() {
    case $(head -c 300 -- "$1" 2> /dev/null | tr -d '\000' | sed 1q) in
    '# stickslip signal '*) return 1 ;;
    '# stickslip '*|onset,end,spikes,*|file,unit,transitions,*|rank,scene,*|rank,law,*|amplitude,frequency,*|index,*,status|index,*,stops,*|\
    method,tol,x_error,*|model,x,x_rms,*|m,a,b,f,re,im,edge|t,kind,x,v,direction) return 0 ;;
    esac
    return 1
}
n=$#
while [ $n -gt 0 ]; do
    file=$1 n=$((n - 1))
    shift
    case $file in -|/dev/stdin|/dev/fd/*|/proc/self/fd/*) die 2 "standard input can be read only once; name files" ;; esac
    path=$file                          # of HDF5, maybe with a dataset
    [ -e "$path" ] || path=${file%%:/*}
    if [ -e "$path" ] && ! [ -f "$path" ] && ! [ -d "$path" ]; then
        die 2 "$file: not a regular file, and can be read only once; name files"
    elif [ -f "$path" ] && is_table "$path"; then
        case $quiet in -q|--quiet) ;; *) say "$file: a table of results, not a recording: left out" ;; esac
    else
        set -- "$@" "$file"
    fi
done
[ $# -gt 0 ] || die 1 "no recordings among the files"

n=$$ made=''
while [ -e "$dir.new.$n" ]; do n=$((n + 1)); done       # one that was killed left it
new=$dir.new.$n work=$dir.new.$n/work
trap 'rm -rf "$new" ${made:+"$made"}' EXIT
trap 'exit 130' HUP INT TERM
mkdir -- "$new" "$work" 2> /dev/null || die 1 "$dir: cannot be made here"
eval "ss-features --summary $quiet $jobs $options $finding -o \"\$new/summaries.tsv\" -- \"\$@\""
status=$?
[ $status = 0 ] || exit $status
exec 2> /dev/null                       # what the shell says of a full disk: die says it in one line
escape < "$new/summaries.tsv" > "$work/escaped" || die 1 "$dir: not written"
for file; do
    row=$((row + 1))
    name=$(printf '%04d-%s' "$row" "${file##*/}" | tr -c 'A-Za-z0-9._-' _ | cut -c1-80).html
    echo "$name" >> "$work/pages" || die 1 "$dir: not written"
    html=$(page "$row" "$file") || exit 1
    write "$name" "$html"
done
index() {
    begin Recordings
    printf '<h1>Recordings</h1>\n<div class="wide"><table>\n%s</table></div>\n' "$(table)"
    if [ -s "$work/decays" ]; then
        printf '<h2>Free decays</h2>\n<div class="wide"><table><thead><tr><th>recording</th><th>mechanism</th>'
        printf '<th>frequency</th><th>damping ratio</th></tr></thead><tbody>\n'
        cat "$work/decays"
        printf '</tbody></table></div>\n'
    fi
    printf '<p>With all digits: <a href="summaries.tsv">summaries.tsv</a>. '
    printf 'libstickslip %s.</p>\n</body></html>\n' "$version"
}
write index.html "$(index)"
rm -r "$work"
# Who makes the folder has its name: another run, or user, who did so meanwhile is told.  It is replaced at once where
# mv can do that, and never gets the report as a folder within it.
if ! mkdir -- "$dir"; then
    [ ! -e "$dir" ] || refuse_dir
    die 1 "$dir: cannot be made here"
fi
made=$dir
mv -T -- "$new" "$dir" || mv -- "$new"/* "$dir" || die 1 "$dir: not written"
made=''
