"""Operations that need no Path job, each in a dialog: edges, pockets and faces."""
