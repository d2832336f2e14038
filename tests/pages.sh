#!/bin/bash
# The pages agree with the tree: every relative link leads to a file and a heading, every path in backticks
# exists, and every listing is the output of its command. Paths can lack their first folders: `queue/pool.c`
# is src/render/queue/pool.c. A listing is a block of code after a line `<!-- listing: COMMAND -->`, in which
# `triptych` is the command under test.
# Given TRIPTYCH and SANITIZE by tests/support/scripts/run.sh; with sanitizers the addresses differ, so
# nothing runs.
#
#   LISTINGS=write TRIPTYCH=build/triptych tests/pages.sh    replaces each listing by the output of its
#   command
set -uo pipefail
cd "$(dirname "$0")/.." || exit 1
[[ -z ${SANITIZE-} ]] || { echo 'ok pages are checked by the plain build' && exit; }

exec perl - README.md src/README.md docs/*.md docs/course/*.md docs/course/*/*.md <<'PERL'
use strict;
use warnings;

my $failed = 0;
my $write = ($ENV{LISTINGS} // '') eq 'write';

sub printed { # what a listing's command prints
    my ($command) = @_;
    $ENV{COMMAND} = $command;
    open my $shell, "-|", "bash", "-c", q{triptych() { "$TRIPTYCH" "$@"; }; set -o pipefail; eval "$COMMAND" 2>&1} or die "bash: $!\n";
    my $text = do { local $/; <$shell> };
    close $shell;
    die "listing: $command: ends with status $?\n$text" if $?;
    return $text;
}

sub content {
    my ($page) = @_;
    open my $in, '<', $page or die "$page: $!\n";
    local $/;
    return <$in>;
}

sub anchor { # of a heading, as hosts of repositories make it
    my ($heading) = @_;
    $heading =~ s/\[([^]]*)\]\([^)]*\)/$1/g;
    $heading =~ s/[^\w\- ]//g;
    return lc($heading) =~ tr/ /-/r;
}

# The source files and streams of the tree, each with a slash before it.
my @files = map { chomp; "/$_" } `find src emu asm tests bench docs -type f`;
my $extension = qr/c|h|def|asm|sh|py|awk|y|l|tri/;
my %known;

sub is_file { # by the last folders and the name, in which * is any text
    my ($path) = @_;
    my $pattern = join '.*', map quotemeta, split /\*/, $path, -1;
    return $known{$path} //= !!grep m{/$pattern$}, @files;
}

sub check_links {
    my ($page) = @_;
    my ($text, @wrong) = content($page);
    my $folder = $page =~ m{^(.*/)} ? $1 : '';
    $text =~ s/^```.*?^```//gms;
    while ($text =~ /\]\((?!https?:)([^)#\s]*)(?:#([^)\s]*))?\)/g) {
        my ($file, $heading) = ($1 eq '' ? $page : $folder . $1, $2);
        if (!-e $file) { push @wrong, "no file $file" }
        elsif (defined $heading && !grep { anchor($_) eq $heading } content($file) =~ /^#+ (.*)$/gm) {
            push @wrong, "no heading $file#$heading";
        }
    }
    while ($text =~ /`((?:src|emu|asm|tests|bench|docs)\/[\w.\/*-]+)`/g) {
        my ($path, @found) = ($1, grep { -e } glob $1);
        push @wrong, "no path $path" if !@found && $path !~ /[A-Z]{4}/;
    }
    while ($text =~ /`([\w.\/*-]+\.(?:$extension))`/g) {
        my $path = $1;
        push @wrong, "no file $path" if $path !~ m{[A-Z]{4}|^(?:build|labs)/} && !is_file($path);
    }
    print "$page: $_\n" for @wrong;
    print @wrong ? 'FAIL' : 'ok', " the links and paths of $page\n";
    $failed = 1 if @wrong;
}

sub check_listings {
    my ($page) = @_;
    my $text = content($page);
    my ($count, $old) = (0, 0);
    my $new = $text =~ s{(<!-- listing: (.*?) -->\n\n?```\w*\n)(.*?)(?=^```$)}{
        my ($head, $command, $is) = ($1, $2, $3);
        my $should = printed($command);
        $count++;
        print "$page: another text is printed by: $command\n" if $is ne $should && ++$old && !$write;
        $head . $should}gmser;
    return if !$count;
    if ($write) {
        open my $out, '>', $page or die "$page: $!\n";
        print $out $new;
        return;
    }
    print $old ? 'FAIL' : 'ok', " the $count listings of $page\n";
    $failed = 1 if $old;
}

for (@ARGV) {
    check_links($_) if !$write;
    check_listings($_);
}
exit $failed;
PERL
