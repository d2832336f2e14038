/* The grammar of chapter 9. The actions make checked nodes (check.h). An error of syntax ends the
 * compilation, as the reports after it would rarely help. */
%code requires {
#include "front/glsl/check/check.h"
}

%code {
#include "front/glsl/compile/lex.h"

/* The parser's stack is on the stack of the thread, so nothing must be freed when the arena refuses
 * memory. */
#define YYINITDEPTH 1500
#define YYMAXDEPTH YYINITDEPTH
#define YYLLOC_DEFAULT(current, right, count) ((current) = (count) ? YYRHSLOC(right, 1) : YYRHSLOC(right, 0))

static void glsl_grammar_error(const struct glsl_place *place, struct glsl_context *context,
                               const char *reason);
}

%define api.pure full
%define api.prefix {glsl_grammar_}
%define api.location.type {struct glsl_place}
%define parse.error custom
%locations
%param {struct glsl_context *context}
/* "(void)" is a list without parameters, and not a parameter of the type void. */
%expect 1

%union {
    const char *name;
    int32_t whole;
    float real;
    uint8_t number;
    bool flag;
    struct glsl_type type;
    struct glsl_specifier specifier;
    struct glsl_expression *expression;
    struct glsl_expressions expressions;
    struct glsl_statement *statement;
    struct glsl_statements statements;
    struct glsl_members members;
    struct glsl_variable *variable;
    struct glsl_function *function;
}

%token <name> IDENTIFIER "a name" TYPE_NAME "the name of a structure"
%token <whole> INTEGER "a whole number"
%token <real> REAL "a number"
%token ATTRIBUTE "attribute" BOOL "bool" BREAK "break" BVEC2 "bvec2" BVEC3 "bvec3" BVEC4 "bvec4" CONST "const"
%token CONTINUE "continue" DISCARD "discard" DO "do" ELSE "else" FALSE "false" FLOAT "float" FOR "for"
%token HIGHP "highp" IF "if" IN "in" INOUT "inout" INT "int" INVARIANT "invariant" IVEC2 "ivec2" IVEC3 "ivec3"
%token IVEC4 "ivec4" LOWP "lowp" MAT2 "mat2" MAT3 "mat3" MAT4 "mat4" MEDIUMP "mediump" OUT "out"
%token PRECISION "precision" RETURN "return" SAMPLER2D "sampler2D" SAMPLERCUBE "samplerCube" STRUCT "struct"
%token TRUE "true" UNIFORM "uniform" VARYING "varying" VEC2 "vec2" VEC3 "vec3" VEC4 "vec4" VOID "void"
%token WHILE "while" LAYOUT "layout" RESERVED "a reserved word" STRAY "a character that the language does not have"
%token LEFT "<<" RIGHT ">>" INC "++" DEC "--" LE "<=" GE ">=" EQ "==" NE "!=" AND "&&" OR "||" XOR "^^"
%token MUL_ASSIGN "*=" DIV_ASSIGN "/=" ADD_ASSIGN "+=" SUB_ASSIGN "-=" MOD_ASSIGN "%=" OTHER_ASSIGN "<<="
%token END 0 "the end of the source"

%precedence WITHOUT_ELSE
%precedence ELSE

%type <expression> primary postfix unary multiplicative additive relational equality and xor or conditional
%type <expression> assignment expression constant optional_expression call
%type <expressions> arguments argument_list
%type <number> unary_operator assignment_operator precision parameter_qualifier
%type <flag> optional_const
%type <type> type_name structure plain_type
%type <specifier> specified specifier specification
%type <members> fields field_list declarators
%type <variable> parameters parameter_list parameter
%type <function> prototype
%type <statement> statement simple block declaration_statement body for_first declared selection
%type <statement> iteration jump
%type <statement> new_scope loop_body
%type <statements> statements declaration declarations

%start unit

%%

unit: external | unit external;

external:
    function
  | declaration                 { (void)$1; }
  | LAYOUT '(' qualifiers ')' OUT ';'
  ;

/* KHR_blend_equation_advanced */
qualifiers:
    IDENTIFIER                  { glsl_check_blend_support(context, @1, $1); }
  | qualifiers ',' IDENTIFIER   { glsl_check_blend_support(context, @3, $3); }
  ;

function:
    prototype                   { glsl_node_begin_function(context, $1); }
    block                       { glsl_node_end_function(context, $3); }
  ;

/* --- Expressions --- */

primary:
    IDENTIFIER                  { $$ = glsl_node_name(context, @1, $1); }
  | INTEGER
        { $$ = glsl_node_literal(context, @1, GLSL_INT, (union glsl_scalar){.i = $1}); }
  | REAL
        { $$ = glsl_node_literal(context, @1, GLSL_FLOAT, (union glsl_scalar){.f = $1}); }
  | TRUE
        { $$ = glsl_node_literal(context, @1, GLSL_BOOL, (union glsl_scalar){.i = 1}); }
  | FALSE
        { $$ = glsl_node_literal(context, @1, GLSL_BOOL, (union glsl_scalar){.i = 0}); }
  | '(' expression ')'          { $$ = $2; }
  ;

postfix:
    primary
  | postfix '[' expression ']'  { $$ = glsl_node_index(context, @2, $1, $3); }
  | call
  | postfix '.' IDENTIFIER      { $$ = glsl_node_field(context, @3, $1, $3); }
  | postfix INC                 { $$ = glsl_node_unary(context, @2, GLSL_INCREMENT_AFTER, $1); }
  | postfix DEC                 { $$ = glsl_node_unary(context, @2, GLSL_DECREMENT_AFTER, $1); }
  ;

call:
    IDENTIFIER '(' arguments ')' { $$ = glsl_node_call(context, @1, $1, &$3); }
  | plain_type '(' arguments ')' { $$ = glsl_node_construct(context, @1, $1, &$3); }
  ;

arguments:
    %empty                      { $$ = (struct glsl_expressions){0}; }
  | VOID                        { $$ = (struct glsl_expressions){0}; }
  | argument_list
  ;

argument_list:
    assignment                  { $$ = (struct glsl_expressions){0}; glsl_node_add_expression(&$$, $1); }
  | argument_list ',' assignment { $$ = $1; glsl_node_add_expression(&$$, $3); }
  ;

unary:
    postfix
  | INC unary                   { $$ = glsl_node_unary(context, @1, GLSL_INCREMENT, $2); }
  | DEC unary                   { $$ = glsl_node_unary(context, @1, GLSL_DECREMENT, $2); }
  | '+' unary                   { $$ = glsl_node_unary(context, @1, GLSL_ADD, $2); }
  | unary_operator unary        { $$ = glsl_node_unary(context, @1, $1, $2); }
  ;

unary_operator:
    '-'                         { $$ = GLSL_NEGATE; }
  | '!'                         { $$ = GLSL_NOT; }
  | '~'                         { $$ = GLSL_NOT; glsl_error(context, @1, "found '~', which is reserved"); }
  ;

multiplicative:
    unary
  | multiplicative '*' unary    { $$ = glsl_node_binary(context, @2, GLSL_MULTIPLY, $1, $3); }
  | multiplicative '/' unary    { $$ = glsl_node_binary(context, @2, GLSL_DIVIDE, $1, $3); }
  ;

additive:
    multiplicative
  | additive '+' multiplicative { $$ = glsl_node_binary(context, @2, GLSL_ADD, $1, $3); }
  | additive '-' multiplicative { $$ = glsl_node_binary(context, @2, GLSL_SUBTRACT, $1, $3); }
  ;

relational:
    additive
  | relational '<' additive     { $$ = glsl_node_binary(context, @2, GLSL_LESS, $1, $3); }
  | relational '>' additive     { $$ = glsl_node_binary(context, @2, GLSL_GREATER, $1, $3); }
  | relational LE additive      { $$ = glsl_node_binary(context, @2, GLSL_LESS_EQUAL, $1, $3); }
  | relational GE additive      { $$ = glsl_node_binary(context, @2, GLSL_GREATER_EQUAL, $1, $3); }
  ;

equality:
    relational
  | equality EQ relational      { $$ = glsl_node_binary(context, @2, GLSL_EQUAL, $1, $3); }
  | equality NE relational      { $$ = glsl_node_binary(context, @2, GLSL_NOT_EQUAL, $1, $3); }
  ;

and:
    equality
  | and AND equality            { $$ = glsl_node_binary(context, @2, GLSL_AND, $1, $3); }
  ;

xor:
    and
  | xor XOR and                 { $$ = glsl_node_binary(context, @2, GLSL_XOR, $1, $3); }
  ;

or:
    xor
  | or OR xor                   { $$ = glsl_node_binary(context, @2, GLSL_OR, $1, $3); }
  ;

conditional:
    or
  | or '?' expression ':' assignment { $$ = glsl_node_choose(context, @2, $1, $3, $5); }
  ;

assignment:
    conditional
  | unary assignment_operator assignment { $$ = glsl_node_assign(context, @2, $2, $1, $3); }
  ;

assignment_operator:
    '='                         { $$ = 0; }
  | MUL_ASSIGN                  { $$ = GLSL_MULTIPLY; }
  | DIV_ASSIGN                  { $$ = GLSL_DIVIDE; }
  | ADD_ASSIGN                  { $$ = GLSL_ADD; }
  | SUB_ASSIGN                  { $$ = GLSL_SUBTRACT; }
  | MOD_ASSIGN                  { $$ = 0; glsl_error(context, @1, "found '%%=', which is reserved"); }
  | OTHER_ASSIGN
        { $$ = 0; glsl_error(context, @1, "found an operation on bits, which is reserved"); }
  ;

expression:
    assignment
  | expression ',' assignment   { $$ = glsl_node_sequence(context, @2, $1, $3); }
  ;

constant: conditional;

optional_expression:
    %empty                      { $$ = NULL; }
  | expression
  ;

/* --- Types --- */

plain_type:
    VOID                        { $$ = glsl_type_of(GLSL_VOID, 1, 1); }
  | FLOAT                       { $$ = glsl_type_of(GLSL_FLOAT, 1, 1); }
  | INT                         { $$ = glsl_type_of(GLSL_INT, 1, 1); }
  | BOOL                        { $$ = glsl_type_of(GLSL_BOOL, 1, 1); }
  | VEC2                        { $$ = glsl_type_of(GLSL_FLOAT, 2, 1); }
  | VEC3                        { $$ = glsl_type_of(GLSL_FLOAT, 3, 1); }
  | VEC4                        { $$ = glsl_type_of(GLSL_FLOAT, 4, 1); }
  | IVEC2                       { $$ = glsl_type_of(GLSL_INT, 2, 1); }
  | IVEC3                       { $$ = glsl_type_of(GLSL_INT, 3, 1); }
  | IVEC4                       { $$ = glsl_type_of(GLSL_INT, 4, 1); }
  | BVEC2                       { $$ = glsl_type_of(GLSL_BOOL, 2, 1); }
  | BVEC3                       { $$ = glsl_type_of(GLSL_BOOL, 3, 1); }
  | BVEC4                       { $$ = glsl_type_of(GLSL_BOOL, 4, 1); }
  | MAT2                        { $$ = glsl_type_of(GLSL_FLOAT, 2, 2); }
  | MAT3                        { $$ = glsl_type_of(GLSL_FLOAT, 3, 3); }
  | MAT4                        { $$ = glsl_type_of(GLSL_FLOAT, 4, 4); }
  | SAMPLER2D                   { $$ = glsl_type_of(GLSL_SAMPLER_2D, 1, 1); }
  | SAMPLERCUBE                 { $$ = glsl_type_of(GLSL_SAMPLER_CUBE, 1, 1); }
  | TYPE_NAME                   { $$ = glsl_lex_record($1, context); }
  ;

type_name:
    plain_type                  { $$ = $1; context->defines_record = false; }
  | structure                   { $$ = $1; context->defines_record = true; }
  ;


precision:
    LOWP                        { $$ = GLSL_LOW; }
  | MEDIUMP                     { $$ = GLSL_MEDIUM; }
  | HIGHP                       { $$ = GLSL_HIGH; }
  ;

specifier:
    type_name                   { $$ = glsl_node_specify(context, @1, $1, 0); }
  | precision type_name         { $$ = glsl_node_specify(context, @2, $2, $1); }
  ;

specified:
    specifier
  | CONST specifier             { $$ = glsl_node_qualify(context, @1, GLSL_CONSTANT_STORAGE, false, $2); }
  | ATTRIBUTE specifier         { $$ = glsl_node_qualify(context, @1, GLSL_ATTRIBUTE, false, $2); }
  | VARYING specifier           { $$ = glsl_node_qualify(context, @1, GLSL_VARYING, false, $2); }
  | INVARIANT VARYING specifier { $$ = glsl_node_qualify(context, @1, GLSL_VARYING, true, $3); }
  | UNIFORM specifier           { $$ = glsl_node_qualify(context, @1, GLSL_UNIFORM, false, $2); }
  ;

/* The names that follow belong to it. Nothing inside of them is another one. */
specification: specified        { context->declared = $1; $$ = $1; };

structure:
    STRUCT IDENTIFIER '{' fields '}' { $$ = glsl_node_record(context, @2, $2, &$4); }
  | STRUCT TYPE_NAME '{' fields '}'  { $$ = glsl_node_record(context, @2, $2, &$4); }
  | STRUCT '{' fields '}'            { $$ = glsl_node_record(context, @1, "", &$3); }
  ;

fields:
    field_list
  | fields field_list {
        $$ = $1;
        $$.last->next = $2.first;
        $$.last = $2.last;
        $$.count += $2.count;
    }
  ;

field_list:
    specifier
        { glsl_check_no_record(context, &$1, "a field"); context->field_type = $1.type; }
    declarators ';'
        { $$ = $3; }
  ;

declarators:
    IDENTIFIER
        {
            $$ = (struct glsl_members){0};
            glsl_node_add_member(context, &$$, @1, context->field_type, $1, NULL, false);
        }
  | IDENTIFIER '[' constant ']'
        {
            $$ = (struct glsl_members){0};
            glsl_node_add_member(context, &$$, @1, context->field_type, $1, $3, true);
        }
  | declarators ',' IDENTIFIER
        { $$ = $1; glsl_node_add_member(context, &$$, @3, context->field_type, $3, NULL, false); }
  | declarators ',' IDENTIFIER '[' constant ']'
        { $$ = $1; glsl_node_add_member(context, &$$, @3, context->field_type, $3, $5, true); }
  ;

/* --- Declarations --- */

declaration:
    prototype ';'               { glsl_node_declare_function(context, $1); $$ = (struct glsl_statements){0}; }
  | declarations ';'
  | PRECISION precision type_name ';'
        { glsl_node_default_precision(context, @1, $2, $3); $$ = (struct glsl_statements){0}; }
  | INVARIANT names ';'         { $$ = (struct glsl_statements){0}; }
  ;

names:
    IDENTIFIER                  { glsl_node_invariant(context, @1, $1); }
  | names ',' IDENTIFIER        { glsl_node_invariant(context, @3, $3); }
  ;

declarations:
    specification
        { glsl_check_empty_declaration(context, &$1); $$ = (struct glsl_statements){0}; }
  | specification declared      { $$ = (struct glsl_statements){0}; glsl_node_add_statement(&$$, $2); }
  | declarations ',' declared   { $$ = $1; glsl_node_add_statement(&$$, $3); }
  ;

declared:
    IDENTIFIER
        { $$ = glsl_node_declare(context, &context->declared, @1, $1, NULL, NULL, false); }
  | IDENTIFIER '[' ']'
        { $$ = glsl_node_declare(context, &context->declared, @1, $1, NULL, NULL, true); }
  | IDENTIFIER '[' constant ']'
        { $$ = glsl_node_declare(context, &context->declared, @1, $1, $3, NULL, true); }
  | IDENTIFIER '=' assignment
        { $$ = glsl_node_declare(context, &context->declared, @1, $1, NULL, $3, false); }
  ;

prototype: specification IDENTIFIER '(' parameters ')'
        { $$ = glsl_node_prototype(context, @2, &$1, $2, $4); };

parameters:
    %empty                      { $$ = NULL; }
  | VOID                        { $$ = NULL; }
  | parameter_list
  ;

/* The list is in reverse order until the prototype is complete. */
parameter_list:
    parameter
  | parameter_list ',' parameter { $3->next = $1; $$ = $3; }
  ;

optional_const:
    %empty                      { $$ = false; }
  | CONST                       { $$ = true; }
  ;

parameter_qualifier:
    %empty                      { $$ = GLSL_IN; }
  | IN                          { $$ = GLSL_IN; }
  | OUT                         { $$ = GLSL_OUT; }
  | INOUT                       { $$ = GLSL_INOUT; }
  ;

parameter:
    optional_const parameter_qualifier specifier
        { $$ = glsl_node_parameter(context, @3, $1, $2, &$3, NULL, NULL, false); }
  | optional_const parameter_qualifier specifier '[' constant ']'
        { $$ = glsl_node_parameter(context, @3, $1, $2, &$3, NULL, $5, true); }
  | optional_const parameter_qualifier specifier IDENTIFIER
        { $$ = glsl_node_parameter(context, @4, $1, $2, &$3, $4, NULL, false); }
  | optional_const parameter_qualifier specifier IDENTIFIER '[' constant ']'
        { $$ = glsl_node_parameter(context, @4, $1, $2, &$3, $4, $6, true); }
  ;

/* --- Statements --- */

block:
    '{' '}'                     { $$ = glsl_node_statement(context, GLSL_BLOCK, @1); }
  | '{' statements '}'          { $$ = glsl_node_statement(context, GLSL_BLOCK, @1); $$->body = $2.first; }
  ;

new_scope: { glsl_scope_open(context, @$); } block { glsl_scope_close(context); $$ = $2; };

statements:
    statement                   { $$ = (struct glsl_statements){0}; glsl_node_add_statement(&$$, $1); }
  | statements statement        { $$ = $1; glsl_node_add_statement(&$$, $2); }
  ;

statement: new_scope | simple;

/* A statement with a scope of its own. */
body: { glsl_scope_open(context, @$); } body_statement { glsl_scope_close(context); $$ = context->body; };

body_statement:
    block                       { context->body = $1; }
  | simple                      { context->body = $1; }
  ;

/* The body of a loop is in the scope of the loop's own variable (6.3). */
loop_body: body_statement       { $$ = context->body; };

simple:
    declaration_statement
  | optional_expression ';'
        { $$ = glsl_node_statement(context, GLSL_EXPRESSION, @1); $$->expression = $1; }
  | selection
  | iteration
  | jump
  ;

declaration_statement: declaration
        { $$ = glsl_node_statement(context, GLSL_EXPRESSION, @1); if ($1.first) $$ = $1.first; };

selection:
    IF '(' expression ')' body %prec WITHOUT_ELSE { $$ = glsl_node_if(context, @1, $3, $5, NULL); }
  | IF '(' expression ')' body ELSE body          { $$ = glsl_node_if(context, @1, $3, $5, $7); }
  ;

condition:
    expression
        { context->condition = NULL; context->tested = $1; glsl_check_condition(context, $1); }
  | specification IDENTIFIER '=' assignment {
        context->condition = glsl_node_declare(context, &$1, @2, $2, NULL, $4, false);
        context->tested = NULL;
        if (context->condition)
            glsl_check_condition(context, glsl_node_name(context, @2, $2));
    }
  ;

optional_condition: %empty { context->condition = NULL; context->tested = NULL; } | condition;

for_first: optional_expression ';'
        { $$ = glsl_node_statement(context, GLSL_EXPRESSION, @1); $$->expression = $1; }
  | declaration { $$ = $1.first; }
  ;

iteration:
    WHILE '(' { glsl_scope_open(context, @1); } condition ')' <statement>{
        $$ = glsl_node_statement(context, GLSL_WHILE, @1);
        $$->condition = context->condition;
        $$->expression = context->tested;
        context->loops++;
    } loop_body {
        $$ = $6;
        $$->body = $7;
        context->loops--;
        glsl_scope_close(context);
    }
  | DO { context->loops++; } body WHILE '(' expression ')' ';' {
        context->loops--;
        glsl_check_condition(context, $6);
        $$ = glsl_node_statement(context, GLSL_DO, @1);
        $$->body = $3;
        $$->expression = $6;
    }
  | FOR '(' { glsl_scope_open(context, @1); } for_first optional_condition ';' <statement>{
        $$ = glsl_node_statement(context, GLSL_FOR, @1);
        $$->first = $4;
        $$->condition = context->condition;
        $$->expression = context->tested;
    } optional_expression ')' { $7->each = $8; context->loops++; } loop_body {
        $$ = $7;
        $$->body = $11;
        context->loops--;
        glsl_scope_close(context);
    }
  ;

jump:
    CONTINUE ';'                { $$ = glsl_node_jump(context, GLSL_CONTINUE, @1, NULL); }
  | BREAK ';'                   { $$ = glsl_node_jump(context, GLSL_BREAK, @1, NULL); }
  | RETURN ';'                  { $$ = glsl_node_jump(context, GLSL_RETURN, @1, NULL); }
  | RETURN expression ';'       { $$ = glsl_node_jump(context, GLSL_RETURN, @1, $2); }
  | DISCARD ';'                 { $$ = glsl_node_jump(context, GLSL_DISCARD, @1, NULL); }
  ;

%%

/* "found 'x', expected a, b or c": the expected tokens are named if they are few. */
static int yyreport_syntax_error(const yypcontext_t *parser, struct glsl_context *context)
{
    enum { MOST = 5 };
    yysymbol_kind_t expected[MOST];
    int count = yypcontext_expected_tokens(parser, expected, MOST);
    const char *list = "";
    for (int i = 0; i < count; i++)
        list = glsl_format(&context->arena, "%s%s%s", list,
                           !i ? ", expected " : i + 1 < count ? ", " : " or ", yysymbol_name(expected[i]));
    glsl_error(context, *yypcontext_location(parser), "found %s%s", glsl_lex_found(context), list);
    return 0;
}

/* Only the parser's stack reports errors by text. */
static void glsl_grammar_error(const struct glsl_place *place, struct glsl_context *context,
                               const char *reason)
{
    (void)reason;
    glsl_error(context, *place, "found more than %d levels of expressions and statements", YYMAXDEPTH);
}

void glsl_parse(struct glsl_context *context)
{
    glsl_grammar_parse(context);
}
