// Macros that headers of X11, Windows, macOS and Qt leave behind. The public header must compile after them, and be usable before them.
#pragma once

// X11/X.h, X11/Xlib.h
#define Status int
#define Bool int
#define True 1
#define False 0
#define None 0L
#define Success 0
#define Always 2
#define Above 0
#define Below 1
#define Complex 0
#define Convex 2
#define CursorShape 0
#define Expose 12
#define FocusIn 9
#define KeyPress 2
#define Unsorted 0
// windows.h
#define near
#define far
#define min(a, b) ((a) < (b) ? (a) : (b))
#define max(a, b) ((a) > (b) ? (a) : (b))
#define small char
#define interface struct
#define ABSOLUTE 1
#define CONST const
#define DELETE 0x00010000L
#define ERROR 0
#define IN
#define OUT
#define OPAQUE 2
#define OPTIONAL
#define STRICT 1
#define TRANSPARENT 1
#define CreateContext CreateContextW
#define GetObject GetObjectW
// AssertMacros.h, objc.h
#define check(x) x
#define verify(x) x
#define require(x, y) x
#define nil 0
// qobjectdefs.h, qforeach.h
#define signals public
#define slots
#define emit
#define foreach(a, b) for (a : b)
#define forever for (;;)
