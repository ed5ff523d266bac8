/* What must hold when nothing more happens. Every history ends (see run.py), so what holds at every end holds in time. */

#define quiet(m) (stop[m] == 0 && !asked_stop[m] && leaf[m] != AGAIN && leaf[m] != ENDS && leaf[m] != STOOD)
#define stopped_or_owned(m) (body[m] == STANDS || (current[m] != 0 && at_server[m] == current[m] \
	&& run_alive(m) && says[m] == run_of(current[m]) && serves[m] == current[m]))

proctype Promises() {
#ifdef HISTORY
	wanted == 0; /* the whole history was read */
	assert(false)
#else
end:	timeout -> atomic {
		assert(quiet(0) && quiet(MACHINES - 1));                       /* every stop has ended */
		assert(stopped_or_owned(0) && stopped_or_owned(MACHINES - 1)); /* nothing moves without its permits */
		assert(!host_press[0] && !host_press[MACHINES - 1])            /* every press has latched */
	}
#endif
}
