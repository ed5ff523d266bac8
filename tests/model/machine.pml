/* A machine: its server takes one goal at a time. */

inline tell_outcome(m, k, how) { /* to the gateway that has sent it, if that still waits */
	if
	:: phase[m] == SENT && current[m] == (k) -> outcome[m] = how
	:: else
	fi
}

inline end_goal(m, how) {
	body[m] = STANDS;
	if
	:: at_server[m] != 0 -> tell_outcome(m, at_server[m], how); at_server[m] = 0; endless[m] = 0
	:: else
	fi
}

proctype Machine(byte m) {
end:	do
	:: atomic { goal_flies[m] != 0 && at_server[m] != 0 ->
		printf("machine %d refuses goal %d\n", m, goal_flies[m]);
		tell_outcome(m, goal_flies[m], BAD); goal_flies[m] = 0 }
	:: atomic { goal_flies[m] != 0 && at_server[m] == 0 && see(ACCEPTS, m, run_of(goal_flies[m])) -> seen;
		printf("machine %d accepts goal %d\n", m, goal_flies[m]);
		promise(run_of(goal_flies[m]) > older[m]); /* an old run moves nothing */
		older[m] = run_of(goal_flies[m]) - 1;
		at_server[m] = goal_flies[m]; goal_flies[m] = 0; body[m] = STARTS;
		if
		:: LONG -> endless[m] = 1
		:: true
		fi }
	:: atomic { body[m] == STARTS -> body[m] = MOVES }
	:: atomic { body[m] == MOVES && !endless[m] ->
		printf("machine %d reaches its goal\n", m);
		end_goal(m, GOOD) }
	:: atomic { cancel_flies[m] || host_cancels[m] ->
		if
		:: cancel_flies[m] -> cancel_flies[m] = 0
		:: host_cancels[m] -> host_cancels[m] = 0
		fi;
		if
		:: sick[m] != DEAF -> printf("machine %d obeys a cancel\n", m); end_goal(m, LOST)
		:: else
		fi }
	od
}
