/* identity.h -- whether what rings is the contact. */
#ifndef IDENTITY_H
#define IDENTITY_H

#include "find/ringdown.h"
#include "find/search.h"

/* The tests that one damped oscillation, fitted to windows, passes before its numbers are printed.  *why becomes
 * the reason why it is not the contact's, or NULL. */
ss_status ss_identity_of(search *s, const ringdown *r, const char **why);

#endif
