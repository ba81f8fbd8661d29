# manual_headers.sh PAGE HEADER ...: the page, with the text of each header where it says HEADERS.
page=$1
shift
sed '/^\.\\" HEADERS$/,$d' "$page"
for header; do
    printf '.Ss stickslip/%s\n.Bd -literal\n' "${header##*/}"
    sed -e 's/\\/\\e/g' -e "s/^[.']/\\\\\&&/" "$header"
    echo .Ed
done
sed '1,/^\.\\" HEADERS$/d' "$page"
