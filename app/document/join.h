#pragma once
// Two documents of one surface become one, in which nothing is missing that somebody made.

#include <string>

#include "app/document/document.h"

namespace dubsar::app {

/// `mine` with what `theirs` has besides, both of which followed from `base`; null: nobody knows from what. Notes and
/// measures are told apart by their ids: what one side took away and the other left as it was is gone; what one side
/// changed is changed; what both changed, or changed and took away, is there in each of its forms, the other side's
/// under an id of its own. Keyframes that only one side changed are that side's; else theirs follow behind mine. Of all
/// other members, but where one looks from, what only they changed is theirs; without a base all of them are mine.
Document join(const Document* base, const Document& mine, const Document& theirs);

/// The same of notes, measures and keyframes alone; all else is mine.
Document join_marks(const Document* base, const Document& mine, const Document& theirs);

/// `mine` with the notes, measures and keyframes of `theirs` that it lacks, and what is said of the tablet where mine
/// says nothing.
Document add_marks(const Document& mine, const Document& theirs);

/// How many notes, measures and keyframes `after` has that `before` has not, in words: "2 notes, 1 measure"; empty:
/// none. What is said of the tablet is named where it was not there.
std::string marks_more(const Document& before, const Document& after);

}  // namespace dubsar::app
